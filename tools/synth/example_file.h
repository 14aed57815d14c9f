#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "passes/specular/perceptual.h"
#include "passes/state/network.h"
#include "sensor/output/new_file.h"
#include "sensor/output/output_file.h"

namespace patina::tools {

/// What precedes the examples of a file; docs/guide/training.md has the format.
struct ExampleFileHeader {
    char magic[8] = {'P', 'A', 'T', 'H', 'E', 'M', 'I', '\0'};
    uint32_t version = 1;
    uint32_t generator = 1;  ///< the ranges that scenes are drawn from
    uint64_t seed = 0;
    uint32_t examples = 0;
    uint32_t example_bytes = 0;
    uint32_t samples = 0;
    uint32_t side = 0;
    uint32_t channels = 0;
    uint32_t map = 0;  ///< HemisphereMap
    uint32_t pad[4] = {};
};
static_assert(sizeof(ExampleFileHeader) == 64);

/// What an example shows; its images follow as halves.
struct ExampleLabel {
    float w[7] = {};
    float kd[3] = {};
    float ks[3] = {};
    float alpha = 0;
    float normal_error_degrees = 0;
    uint32_t windows = 0;  ///< of the environment; 0: lamps alone
};
static_assert(sizeof(ExampleLabel) == 64);

/// Writes a file of examples, which appears whole or not at all.
class ExampleFileWriter {
  public:
    /// Throws Error when the file exists or cannot be written.
    ExampleFileWriter(const std::filesystem::path& file, uint64_t seed, uint32_t examples, HemisphereMap map);

    /// `halves`: gpu::kExampleHalves of them. Throws Error when the disk is full.
    void write(const ExampleLabel& label, std::span<const uint16_t> halves);
    bool is_full() const { return written_ == header_.examples; }
    uint32_t written() const { return written_; }
    /// Throws Error when the disk is full or the file cannot be put in place.
    void finish();

  private:
    sensor::OutputFile file_;
    sensor::NewFile out_;
    ExampleFileHeader header_;
    uint32_t written_ = 0;
};

}  // namespace patina::tools
