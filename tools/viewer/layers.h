#pragma once

#include <array>
#include <optional>
#include <string_view>

#include <glm/glm.hpp>

#include "passes/viewer/draw_layer.h"
#include "reconstruction/model_view.h"

namespace patina::tools {

/// What a picture shows of the model.
enum class Layer { kColor, kRerendering, kKd, kKs, kAlpha, kNormals, kSegments, kConfidence, kCoverage };

/// What the user reads of a layer.
struct LayerText {
    Layer layer;
    std::string_view word;   ///< of the option
    std::string_view title;  ///< in the window
    std::string_view help;   ///< one sentence
};

/// All of them, by number.
inline constexpr std::array<LayerText, 9> kLayers{{
    {Layer::kColor, "color", "Colour", "The fused colours of the camera."},
    {Layer::kRerendering, "rerendering", "Re-rendering", "The materials under the lamps."},
    {Layer::kKd, "kd", "Diffuse albedo", "kd: what is left of the colour without light."},
    {Layer::kKs, "ks", "Specular albedo", "ks, one colour a segment."},
    {Layer::kAlpha, "alpha", "Roughness", "Ward's alpha, one value a segment: low is glossy."},
    {Layer::kNormals, "normals", "Normals", "World normals: red is x, green is y, blue is z."},
    {Layer::kSegments, "segments", "Segments", "A colour for each segment."},
    {Layer::kConfidence, "confidence", "Confidence", "How certain the diffuse albedo is."},
    {Layer::kCoverage, "coverage", "Coverage",
     "Observations of each 2 cm voxel, up to 30: scan next where it is dark."},
}};
inline const LayerText& text_of(Layer layer) { return kLayers[static_cast<size_t>(layer)]; }

/// The values that the ends of a layer's scale of colours stand for; empty where it has none.
std::optional<glm::vec2> scale_of(Layer layer);

/// A colour of the scale, 0 to 1, encoded for sRGB: that of the shader. `at` is clipped to 0..1.
glm::vec3 scale_color(float at);

/// Whether a model has what the layer shows.
bool has_layer(Layer layer, bool reflectance, bool segmentation);

/// How a layer is drawn from a camera at `camera_m`; `exposure` is what radiance is multiplied with.
gpu::DrawLayerParams params_of(Layer layer, glm::dvec3 camera_m, float exposure);

/// Draws a layer that the model has into `picture` (add_draw_layer).
void add_layer(graph::FrameGraph& graph, const ModelImages& model, Layer layer, const gpu::DrawLayerParams& params,
               graph::ImageId picture);

}  // namespace patina::tools
