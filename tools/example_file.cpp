#include "tools/example_file.h"

#include <system_error>

#include <unistd.h>

#include "engine/core/error.h"
#include "shared/example_scenes.h"

namespace patina::tools {

namespace fs = std::filesystem;

ExampleFileWriter::ExampleFileWriter(fs::path file, uint64_t seed, uint32_t examples, HemisphereMap map)
    : file_(std::move(file)), partial_(file_.string() + ".partial-" + std::to_string(getpid())) {
    if (fs::exists(file_)) throw Error(file_.string(), " exists already");
    header_.seed = seed;
    header_.examples = examples;
    header_.example_bytes = sizeof(ExampleLabel) + gpu::kExampleHalves * sizeof(uint16_t);
    header_.samples = gpu::kHemiSamples;
    header_.side = gpu::kHemiSide;
    header_.channels = 3;
    header_.map = static_cast<uint32_t>(map);
    out_.open(partial_, std::ios::binary);
    out_.write(reinterpret_cast<const char*>(&header_), sizeof(header_));
    if (!out_) throw Error(file_.string(), " cannot be written");
}

ExampleFileWriter::~ExampleFileWriter() {
    std::error_code ignored;
    fs::remove(partial_, ignored);
}

void ExampleFileWriter::write(const ExampleLabel& label, std::span<const uint16_t> halves) {
    PATINA_ASSERT(!is_full() && halves.size() == gpu::kExampleHalves, halves.size());
    out_.write(reinterpret_cast<const char*>(&label), sizeof(label));
    out_.write(reinterpret_cast<const char*>(halves.data()), static_cast<std::streamsize>(halves.size_bytes()));
    ++written_;
}

void ExampleFileWriter::finish() {
    PATINA_ASSERT(is_full(), written_, " of ", header_.examples);
    out_.close();
    if (!out_) throw Error(file_.string(), " cannot be written: is the disk full?");
    std::error_code failure;
    fs::rename(partial_, file_, failure);
    if (failure) throw Error(file_.string(), " cannot be put in place: ", failure.message());
}

}  // namespace patina::tools
