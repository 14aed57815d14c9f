#include "tools/run_specular.h"

#include "engine/core/error.h"
#include "sensor/synthetic/scene_file.h"
#include "tools/network_file.h"

namespace patina::tools {

namespace {

/// The network that the user names, or that ships with the program; empty where there is none.
std::filesystem::path network_file(const SequenceOptions& options) {
    if (!options.network.empty()) return options.network;
    const std::filesystem::path shipped = sensor::assets_folder() / "hemicnn.safetensors";
    return std::filesystem::exists(shipped) ? shipped : std::filesystem::path();
}

}  // namespace

std::optional<NetworkDescription> read_network(const SequenceOptions& options) {
    if (options.truth_materials || options.specular == "off" || options.specular == "fit") return {};
    const std::filesystem::path file = network_file(options);
    if (!file.empty()) return read_network_file(file);
    if (options.specular.empty()) return {};
    throw Error("--specular ", options.specular, " needs a network: give --network FILE");
}

void set_specular(ReconstructionSettings& settings, const SequenceOptions& options,
                  std::optional<NetworkDescription> network) {
    const bool possible = settings.reflectance && settings.segmentation && !options.truth_materials;
    if (!possible || options.specular == "off") {
        settings.specular.reset();
        return;
    }
    if (!settings.specular) settings.specular.emplace();
    settings.specular->fit = options.specular != "hemicnn";
    settings.network = std::move(network);
}

std::string specular_mode(const ReconstructionSettings& settings) {
    if (!settings.specular) return "off";
    return !settings.network ? "fit" : settings.specular->fit ? "both" : "hemicnn";
}

}  // namespace patina::tools
