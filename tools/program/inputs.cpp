#include "tools/program/inputs.h"

#include <string_view>
#include <system_error>

#include "sensor/open.h"
#include "sensor/output/apart.h"

namespace patina::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSynthetic = "synthetic:";

}  // namespace

std::vector<fs::path> sequence_inputs(const std::string& sequence) {
    if (sequence.starts_with(kSynthetic)) {
        const fs::path scene = sequence.substr(kSynthetic.size());
        std::error_code none;
        return fs::is_regular_file(scene, none) ? std::vector{scene} : std::vector<fs::path>();
    }
    if (sequence.empty()) return {};  // who opens it reports that
    const fs::path given = fs::absolute(sequence).lexically_normal();
    const bool names_parent = given.filename() == "sequence.json" || !given.has_filename();
    const fs::path folder = names_parent ? given.parent_path() : given;
    std::vector<fs::path> inputs{folder};
    if (fs::path main = sensor::main_of(folder); !main.empty()) inputs.push_back(std::move(main));
    return inputs;
}

std::vector<fs::path> inputs_of(const SequenceOptions& options) {
    std::vector<fs::path> inputs = sequence_inputs(options.sequence);
    if (const auto* elsewhere = std::get_if<LightsFromSequence>(&options.lighting)) {
        for (fs::path& each : sequence_inputs(elsewhere->sequence)) inputs.push_back(std::move(each));
    }
    if (const auto* lights = std::get_if<LightsFromFile>(&options.lighting)) inputs.push_back(lights->file);
    for (const fs::path& file : {options.network, options.settings_file, options.extends}) {
        if (!file.empty()) inputs.push_back(file);
    }
    return inputs;
}

}  // namespace patina::tools
