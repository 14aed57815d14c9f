#include "tools/run_settings.h"

#include <cmath>
#include <optional>
#include <sstream>
#include <type_traits>

#include <toml++/toml.h>

#include "engine/core/did_you_mean.h"
#include "engine/core/error.h"
#include "engine/core/input_file.h"

namespace patina::tools {

namespace {

/// The one list of settings: calls visit(key, value) for each. Keys are those of the TOML file, with their table.
template <class Settings, class Visit>
void for_each_setting(Settings& s, Visit&& visit) {
    visit("map.voxel_m", s.map.voxel_m);
    visit("map.capacity_blocks", s.map.limit_blocks);
    visit("fusion.truncation_m", s.fusion.truncation_m);
    visit("fusion.truncation_slope", s.fusion.truncation_slope);
    visit("fusion.max_depth_m", s.fusion.max_depth_m);
    visit("fusion.max_weight", s.fusion.max_weight);
    visit("fusion.max_color_weight", s.fusion.max_color_weight);
    visit("fusion.settled_color_every", s.fusion.settled_color_every);
    visit("fusion.color", s.fusion.color);
    visit("fusion.allocation_stride_px", s.fusion.allocation_stride_px);
    visit("input.sigma_px", s.input.filter.sigma_px);
    visit("input.sigma_floor_m", s.input.filter.sigma_floor_m);
    visit("input.sigma_linear", s.input.filter.sigma_linear);
    visit("input.sigma_quadratic", s.input.filter.sigma_quadratic);
    visit("view.near_m", s.near_m);
    visit("view.every_frame", s.view_every_frame);
    visit("map.remove_every", s.remove_every);
    if (s.segmentation) {
        visit("segmentation.capacity_labels", s.segmentation->limit_labels);
        visit("segmentation.min_pixels", s.segmentation->frame.min_pixels);
        visit("segmentation.stride_px", s.segmentation->frame.stride_px);
        visit("segmentation.crease_degrees", s.segmentation->frame.edges.crease_degrees);
        visit("segmentation.crease_sigmas", s.segmentation->frame.edges.crease_sigmas);
        visit("segmentation.jump_m", s.segmentation->frame.edges.jump_m);
        visit("segmentation.inherit_share", s.segmentation->inherit_share);
        visit("segmentation.inherit_pixels", s.segmentation->inherit_pixels);
        visit("segmentation.new_pixels", s.segmentation->new_pixels);
        visit("segmentation.merge_share", s.segmentation->merge_share);
        visit("segmentation.merge_frames", s.segmentation->merge_frames);
        visit("segmentation.merge_chroma", s.segmentation->merge_chroma);
        visit("segmentation.merge_brightness", s.segmentation->merge_brightness);
        visit("segmentation.merge_ks", s.segmentation->merge_ks);
        visit("segmentation.merge_alpha", s.segmentation->merge_alpha);
        visit("segmentation.prune_voxels", s.segmentation->prune_voxels);
        visit("segmentation.prune_frames", s.segmentation->prune_frames);
    }
    if (s.gains) {
        visit("gains.reduction", s.gains->reduction);
        visit("gains.max_angle_degrees", s.gains->max_angle_degrees);
        visit("gains.min_samples", s.gains->min_samples);
        visit("gains.leak", s.gains->leak);
    }
    if (s.reflectance) {
        visit("reflectance.voxel_m", s.reflectance->voxel_m);
        visit("reflectance.capacity_blocks", s.reflectance->limit_blocks);
        visit("reflectance.capacity_records", s.reflectance->limit_records);
        visit("reflectance.shadows", s.reflectance->refine.shadows);
        visit("reflectance.first_marched_records", s.reflectance->refine.first_marched_records);
        visit("reflectance.marched_records", s.reflectance->refine.marched_records);
        visit("reflectance.refreshed_records", s.reflectance->refine.refreshed_records);
        visit("observe.stride_px", s.reflectance->observe.stride_px);
        visit("observe.max_distance_m", s.reflectance->observe.max_distance_m);
        visit("observe.max_angle_degrees", s.reflectance->observe.max_angle_degrees);
        visit("observe.depth_tolerance_m", s.reflectance->observe.depth_tolerance_m);
        visit("observe.edge_margin_px", s.reflectance->observe.edge_margin_px);
        visit("observe.max_blur_px", s.reflectance->observe.max_blur_px);
        visit("observe.rest_px", s.reflectance->observe.rest_px);
    }
    if (s.tracking) {
        visit("tracking.levels", s.tracking->levels);
        visit("tracking.finest", s.tracking->finest);
        visit("tracking.iterations", s.tracking->iterations);
        visit("tracking.finest_iterations", s.tracking->finest_iterations);
        visit("tracking.photometric", s.tracking->photometric);
        visit("tracking.hide_highlights", s.tracking->hide_highlights);
        visit("tracking.damping", s.tracking->damping);
        visit("tracking.noise_floor_m", s.tracking->errors.noise_floor_m);
        visit("tracking.noise_per_m", s.tracking->errors.noise_per_m);
        visit("tracking.robust_sigmas", s.tracking->errors.robust_sigmas);
        visit("tracking.gate_m", s.tracking->errors.gate_m);
        visit("tracking.gate_slope", s.tracking->errors.gate_slope);
        visit("tracking.shade_sigma", s.tracking->errors.shade_sigma);
        visit("tracking.robust_shade", s.tracking->errors.robust_shade);
        visit("tracking.least_pairs", s.tracking->bounds.least_pairs);
        visit("tracking.weak_share", s.tracking->bounds.weak_share);
        visit("tracking.lost_share", s.tracking->bounds.lost_share);
        visit("tracking.weak_sigmas", s.tracking->bounds.weak_sigmas);
        visit("tracking.lost_sigmas", s.tracking->bounds.lost_sigmas);
        visit("tracking.held_share", s.tracking->bounds.held_share);
        visit("tracking.weak_step_m", s.tracking->bounds.weak_step_m);
        visit("tracking.weak_step_degrees", s.tracking->bounds.weak_step_degrees);
        visit("tracking.jump_share", s.tracking->bounds.jump_share);
        visit("tracking.lost_motion_m", s.tracking->bounds.lost_motion_m);
        visit("tracking.lost_motion_degrees", s.tracking->bounds.lost_motion_degrees);
    }
    if (s.keyframes) {
        visit("keyframes.capacity", s.keyframes->store.capacity);
        visit("keyframes.seed", s.keyframes->store.seed);
        visit("keyframes.least_depth_m", s.keyframes->store.least_depth_m);
        visit("keyframes.most_depth_m", s.keyframes->store.most_depth_m);
        visit("keyframes.least_dissimilarity", s.keyframes->store.least_dissimilarity);
        visit("keyframes.near_m", s.keyframes->store.near_m);
        visit("keyframes.near_degrees", s.keyframes->store.near_degrees);
        visit("keyframes.candidates", s.keyframes->candidates);
    }
    if (s.specular) {
        visit("specular.segments_per_frame", s.specular->segments_per_frame);
        visit("specular.memory", s.specular->memory);
        visit("specular.seed", s.specular->seed);
    }
}

std::vector<std::string> known_keys() {
    std::vector<std::string> keys;
    ReconstructionSettings defaults;
    defaults.gains.emplace();
    defaults.reflectance.emplace();
    defaults.segmentation.emplace();
    defaults.specular.emplace();
    defaults.tracking.emplace();
    defaults.keyframes.emplace();
    for_each_setting(defaults, [&](const char* key, const auto&) { keys.emplace_back(key); });
    return keys;
}

/// What may be meant by a key that there is not: the most similar one, else all there are.
std::string instead_of(const std::string& key) {
    const std::vector<std::string> keys = known_keys();
    if (const std::string meant = did_you_mean(key, keys); !meant.empty()) return meant;
    std::string list;
    for (const std::string& known : keys) list += (list.empty() ? "; known are " : ", ") + known;
    return list;
}

/// Stores a number where it fits the setting's type; false where it does not.
template <class Value>
bool assign(Value& setting, double number) {
    if constexpr (std::is_same_v<Value, bool>) {
        if (number != 0 && number != 1) return false;
    } else if constexpr (std::is_integral_v<Value>) {
        if (!(number >= 0 && number <= 4294967295.0) || number != std::floor(number)) return false;
    } else if (!(std::isfinite(number) && number >= 0)) {
        return false;
    }
    setting = static_cast<Value>(number);
    return true;
}

void set(ReconstructionSettings& settings, const std::string& key, std::optional<double> number,
         const std::string& written, const std::string& where) {
    if (!settings.reflectance && (key.starts_with("reflectance.") || key.starts_with("observe."))) {
        settings.reflectance.emplace();
    }
    if (!settings.segmentation && key.starts_with("segmentation.")) settings.segmentation.emplace();
    if (!settings.gains && key.starts_with("gains.")) settings.gains.emplace();
    if (!settings.specular && key.starts_with("specular.")) settings.specular.emplace();
    if (!settings.tracking && key.starts_with("tracking.")) settings.tracking.emplace();
    if (!settings.keyframes && key.starts_with("keyframes.")) settings.keyframes.emplace();
    bool known = false;
    for_each_setting(settings, [&](const char* name, auto& setting) {
        if (key != name) return;
        known = true;
        if (!number || !assign(setting, *number)) {
            throw Error(
                where, ": ", key, " is ", written, ", it must be a non-negative ",
                std::is_floating_point_v<std::remove_reference_t<decltype(setting)>> ? "number" : "whole number");
        }
    });
    if (!known) throw Error(where, ": there is no setting '", key, "'", instead_of(key));
}

std::optional<double> number_of(const toml::node& node) {
    if (const auto flag = node.value_exact<bool>()) return *flag ? 1 : 0;
    if (node.is_number()) return node.value<double>();
    return std::nullopt;
}

}  // namespace

void load_settings(ReconstructionSettings& settings, const std::filesystem::path& file) {
    const std::vector<uint8_t> bytes = read_file(file, limits::kSettingsBytes);
    toml::table root;
    try {
        root = toml::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()), file.string());
    } catch (const toml::parse_error& error) {
        throw Error(file.string(), ", line ", error.source().begin.line, ": ", error.description());
    }
    for (const auto& [table_name, table] : root) {
        const std::string prefix(table_name.str());
        if (!table.is_table()) throw Error(file.string(), ": '", prefix, "' is not a table of settings");
        for (const auto& [name, node] : *table.as_table()) {
            std::ostringstream written;
            node.visit([&](const auto& value) { written << value; });
            set(settings, prefix + '.' + std::string(name.str()), number_of(node), written.str(), file.string());
        }
    }
}

void apply_setting(ReconstructionSettings& settings, const std::string& assignment) {
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos) throw Error("--set ", assignment, " has no '=' between key and value");
    const std::string key = assignment.substr(0, equals), value = assignment.substr(equals + 1);
    std::istringstream in(value);
    in.imbue(std::locale::classic());
    double number = 0;
    std::optional<double> parsed;
    if (value == "true" || value == "false") {
        parsed = value == "true";
    } else if (in >> number && in.peek() == std::char_traits<char>::eof()) {
        parsed = number;
    }
    set(settings, key, parsed, "'" + value + "'", "--set");
}

nlohmann::ordered_json settings_json(const ReconstructionSettings& settings) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for_each_setting(settings, [&](const char* key, const auto& value) {
        // Floats as they are written: 0.005, not the double nearest to the float.
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, float>) {
            json[key] = std::stod(text(value));
        } else {
            json[key] = value;
        }
    });
    return json;
}

}  // namespace patina::tools
