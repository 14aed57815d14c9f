#include "export/glb_extras.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace patina {

using Value = tinygltf::Value;

Value array_of(glm::dvec3 v) { return Value(Value::Array{Value(v.x), Value(v.y), Value(v.z)}); }

Value ward_extras(const SegmentReflectance& segment, bool observed) {
    Value::Object ward{{"variant", Value(std::string("ward"))}, {"observed", Value(observed)}};
    if (segment.gloss) {
        Value::Object values{{"ks", array_of(glm::dvec3(segment.gloss->ks))},
                             {"alpha", Value(double{segment.gloss->alpha})}};
        if (is_observed(*segment.gloss)) {
            ward.merge(values);
        } else {
            ward["guess"] = Value(std::move(values));
        }
    }
    if (!ward.contains("ks")) ward["gloss"] = Value(std::string("not observed"));
    return Value(Value::Object{{"ward", Value(std::move(ward))}});
}

namespace {

Value photometric(double candela_per_intensity) {
    return Value(Value::Object{
        {"candela_per_intensity", Value(candela_per_intensity)},
        {"meaning", Value(std::string("intensity of a light / candela_per_intensity = linear pixel value of the "
                                      "recording * m^2; the factor gives a white surface at the scene's mean "
                                      "irradiance 500 lux, and is no measurement"))}});
}

/// In the root node's frame; irradiance in linear pixel values of the recording, of a surface that faces the sun.
Value suns_array(const std::vector<Light>& suns) {
    Value::Array all;
    for (const Light& sun : suns) {
        const glm::dvec3 irradiance = sun.intensity / glm::dot(sun.position_m, sun.position_m);
        all.emplace_back(Value::Object{{"direction", array_of(glm::normalize(sun.position_m))},
                                       {"irradiance", array_of(irradiance)}});
    }
    return Value(std::move(all));
}

/// In the root node's frame.
Value windows_array(const std::vector<AreaLight>& windows, double luminance_per_pixel_value) {
    Value::Array all;
    for (const AreaLight& window : windows)
        all.emplace_back(Value::Object{{"center", array_of(window.center_m)},
                                       {"half_u", array_of(window.half_u_m)},
                                       {"half_v", array_of(window.half_v_m)},
                                       {"luminance", array_of(window.radiance * luminance_per_pixel_value)},
                                       {"clipped", Value(window.clipped)}});
    return Value(std::move(all));
}

Value environment_extras(const GlbEnvironment& environment) {
    const glm::dquat turn = environment.y_up_from_root;
    return Value(Value::Object{
        {"file", Value(environment.file)},
        {"luminance_per_pixel_value", Value(environment.luminance_per_pixel_value)},
        {"y_up_from_root", Value(Value::Array{Value(turn.x), Value(turn.y), Value(turn.z), Value(turn.w)})},
        {"meaning", Value(std::string("light from afar without the lamps: latitude-longitude picture of radiance in "
                                      "cd/m^2; y is up, the middle is +x, the right half +z; divided by "
                                      "luminance_per_pixel_value: linear pixel values of the recording"))}});
}

/// Lamps and light from afar have one scale; without either there is none.
std::optional<double> luminance_per_pixel_value(const GlbInfo& info) {
    if (!info.lights.empty()) return info.candela_per_intensity;
    return info.environment ? std::optional(info.environment->luminance_per_pixel_value) : std::nullopt;
}

}  // namespace

Value scene_extras(const GlbInfo& info) {
    Value::Object extras;
    if (!info.lights.empty()) extras["photometric"] = photometric(info.candela_per_intensity);
    if (!info.suns.empty()) extras["suns"] = suns_array(info.suns);
    if (const auto scale = luminance_per_pixel_value(info); scale && !info.windows.empty())
        extras["windows"] = windows_array(info.windows, *scale);
    if (info.environment) extras["environment"] = environment_extras(*info.environment);
    return extras.empty() ? Value() : Value(std::move(extras));
}

}  // namespace patina
