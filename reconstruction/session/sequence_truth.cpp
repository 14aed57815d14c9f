#include "reconstruction/session/sequence_truth.h"

#include <utility>

#include "engine/core/input_file.h"
#include "sensor/files/picture_file.h"

namespace patina {

SequenceTruth::SequenceTruth(std::filesystem::path sequence, const scenes::SyntheticSource* rendered)
    : folder_(std::move(sequence) / "truth"), rendered_(rendered) {}

Image<uint16_t> SequenceTruth::labels(uint32_t frame, Extent2D extent) const {
    if (rendered_) return rendered_->truth().labels;
    const auto file = folder_ / "labels" / (sensor::picture_stem(frame) + ".png");
    DepthImage labels = sensor::read_depth(file, extent);
    if (auto* ids = std::get_if<Image<uint16_t>>(&labels)) return std::move(*ids);
    throw Error(file.string(), " holds floats, labels are 16-bit integers");
}

std::vector<sensor::Material> SequenceTruth::materials() const {
    return rendered_ ? scenes::materials_of(rendered_->scene()) : sensor::read_materials(folder_ / "materials.json");
}

std::vector<std::string> SequenceTruth::names() const {
    std::vector<std::string> names;
    if (!rendered_ && !path_exists(folder_ / "materials.json")) return names;
    for (const sensor::Material& material : materials()) {
        if (material.id >= names.size()) names.resize(material.id + size_t{1});
        names[material.id] = material.name;
    }
    return names;
}

}  // namespace patina
