#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace patina {

/// An array of numbers, the last index running fastest.
struct Tensor {
    std::vector<uint64_t> shape;
    std::vector<float> values;
};

/// What a safetensors file holds: tensors by name, and strings.
struct TensorFile {
    std::string file;  ///< as it was named
    std::map<std::string, std::string> metadata;
    std::map<std::string, Tensor> tensors;
};

/// Reads a safetensors file: the length of the header in 8 bytes, little-endian, a header in JSON, raw data. Throws
/// Error, naming the file and the field, when the header is above 1 MiB or no such JSON, a tensor is not F32, holds a
/// number that is not finite, or has a size that its shape does not ask for, and when tensors do not lie side by side
/// and fill the file.
TensorFile read_tensor_file(const std::filesystem::path& file);

/// "[16, 3, 3, 3]"
std::string text_of_shape(const std::vector<uint64_t>& shape);

}  // namespace patina
