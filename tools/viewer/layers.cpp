#include "tools/viewer/layers.h"

#include <algorithm>

namespace patina::tools {

namespace {

constexpr float kShoulder = 0.8f;  // of radiance: highlights keep their shape
constexpr float kRelief = 0.6f;    // where colours tell nothing of the shape
constexpr float kMostAlpha = 0.5f;

/// Whether it is what light makes of the surface, whose brightness has no limit.
bool is_radiance(Layer layer) { return layer == Layer::kColor || layer == Layer::kRerendering; }

graph::ImageId values_of(const ModelImages& model, Layer layer) {
    switch (layer) {
        case Layer::kColor:
        case Layer::kNormals: return model.color;  // of normals any
        case Layer::kRerendering: return model.reflectance->seen.rgb;
        case Layer::kKd: return model.reflectance->seen.kd;
        case Layer::kKs:
        case Layer::kAlpha: return model.reflectance->seen.ks_alpha;
        case Layer::kConfidence:
        case Layer::kCoverage: return model.reflectance->coverage;
        case Layer::kSegments: break;
    }
    return {};
}

}  // namespace

std::optional<glm::vec2> scale_of(Layer layer) {
    switch (layer) {
        case Layer::kAlpha: return glm::vec2(0, kMostAlpha);
        case Layer::kConfidence: return glm::vec2(0, 1);
        case Layer::kCoverage: return glm::vec2(0, static_cast<float>(gpu::kMaxObservations));
        default: return std::nullopt;
    }
}

glm::vec3 scale_color(float at) {
    static constexpr std::array<glm::vec3, 5> kStops{{{0.267f, 0.005f, 0.329f},
                                                      {0.230f, 0.322f, 0.546f},
                                                      {0.128f, 0.567f, 0.551f},
                                                      {0.369f, 0.789f, 0.383f},
                                                      {0.993f, 0.906f, 0.144f}}};
    const float along = std::clamp(at, 0.0f, 1.0f) * (kStops.size() - 1);
    const size_t below = std::min(static_cast<size_t>(along), kStops.size() - 2);
    return glm::mix(kStops[below], kStops[below + 1], along - static_cast<float>(below));
}

bool has_layer(Layer layer, bool reflectance, bool segmentation) {
    switch (layer) {
        case Layer::kColor:
        case Layer::kNormals: return true;
        case Layer::kSegments: return segmentation;
        default: return reflectance;
    }
}

gpu::DrawLayerParams params_of(Layer layer, glm::dvec3 camera_m, float exposure) {
    const std::optional<glm::vec2> scale = scale_of(layer);
    gpu::DrawLayerParams params{};
    params.style = layer == Layer::kNormals ? gpu::kDrawNormal : scale ? gpu::kDrawScale : gpu::kDrawColor;
    params.channel = layer == Layer::kAlpha ? 3 : layer == Layer::kConfidence ? 1 : 0;
    params.low = scale ? scale->x : 0;
    params.high = scale ? scale->y : 1;
    params.exposure = is_radiance(layer) ? exposure : 1;
    params.shoulder = is_radiance(layer) ? kShoulder : 1;
    params.camera_m = glm::vec4(camera_m, scale || layer == Layer::kSegments ? kRelief : 0.0f);
    return params;
}

void add_layer(graph::FrameGraph& graph, const ModelImages& model, Layer layer, const gpu::DrawLayerParams& params,
               graph::ImageId picture) {
    const DrawnSurface surface{model.position_m, model.normal};
    if (layer == Layer::kSegments)
        add_draw_segments(graph, surface, *model.label, params, picture);
    else
        add_draw_layer(graph, surface, values_of(model, layer), params, picture);
}

}  // namespace patina::tools
