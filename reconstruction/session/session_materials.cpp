#include "reconstruction/session/session_materials.h"

#include "engine/core/error.h"
#include "reconstruction/session/choices.h"
#include "reconstruction/session/network_file.h"
#include "scenes/files/scene_file.h"

namespace patina {

namespace {

/// The network that the user names, or that ships with the program; empty where there is none.
std::filesystem::path network_file(const SessionOptions& options) {
    if (!options.network.empty()) return options.network;
    const std::filesystem::path shipped = scenes::assets_folder() / "hemicnn.safetensors";
    return std::filesystem::exists(shipped) ? shipped : std::filesystem::path();
}

}  // namespace

std::optional<NetworkDescription> read_network(const SessionOptions& options) {
    const Materials asked = options.materials;
    if (asked == Materials::kTruth || asked == Materials::kOff || asked == Materials::kFit) return {};
    const std::filesystem::path file = network_file(options);
    if (!file.empty()) return read_network_file(file);
    if (asked == Materials::kAuto) return {};
    throw Error(hinted("materials by the network need its weights, which are not installed: give their file",
                       options.hints.network));
}

void set_specular(ReconstructionSettings& settings, const SessionOptions& options,
                  std::optional<NetworkDescription> network) {
    const bool possible = settings.reflectance && settings.segmentation && options.materials != Materials::kTruth;
    if (!possible || options.materials == Materials::kOff) {
        settings.specular.reset();
        return;
    }
    if (!settings.specular) settings.specular.emplace();
    settings.specular->fit = options.materials != Materials::kNetwork;
    settings.network = std::move(network);
}

std::string specular_mode(const ReconstructionSettings& settings) {
    if (!settings.specular) return "off";
    return !settings.network ? "fit" : settings.specular->fit ? "both" : "hemicnn";
}

}  // namespace patina
