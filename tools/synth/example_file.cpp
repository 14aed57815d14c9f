#include "tools/synth/example_file.h"

#include "engine/core/error.h"
#include "shared/scenes/example_scenes.h"

namespace patina::tools {

ExampleFileWriter::ExampleFileWriter(const std::filesystem::path& file, uint64_t seed, uint32_t examples,
                                     HemisphereMap map)
    : file_(file, {}, sensor::OutputFile::Existing::kRefused), out_(file_.partial_path()) {
    header_.seed = seed;
    header_.examples = examples;
    header_.example_bytes = sizeof(ExampleLabel) + gpu::kExampleHalves * sizeof(uint16_t);
    header_.samples = gpu::kHemiSamples;
    header_.side = gpu::kHemiSide;
    header_.channels = 3;
    header_.map = static_cast<uint32_t>(map);
    out_.write({reinterpret_cast<const char*>(&header_), sizeof(header_)});
}

void ExampleFileWriter::write(const ExampleLabel& label, std::span<const uint16_t> halves) {
    PATINA_ASSERT(!is_full() && halves.size() == gpu::kExampleHalves, halves.size());
    out_.write({reinterpret_cast<const char*>(&label), sizeof(label)});
    out_.write({reinterpret_cast<const char*>(halves.data()), halves.size_bytes()});
    ++written_;
}

void ExampleFileWriter::finish() {
    PATINA_ASSERT(is_full(), written_, " of ", header_.examples);
    out_.close();
    file_.finish();
}

}  // namespace patina::tools
