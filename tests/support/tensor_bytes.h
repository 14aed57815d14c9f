#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "passes/state/network.h"

namespace patina::test {

/// A safetensors file in the making: tests spoil a part of it, then join the parts.
struct TensorBytes {
    nlohmann::json header;
    std::string data;

    /// Appends a tensor.
    void add(const std::string& name, const std::vector<uint64_t>& shape, const std::vector<float>& values);
    /// The bytes of the file.
    std::string joined() const;
};

/// A network (format: docs/develop/specular.md); the list of layers apart, for __metadata__.network as a string.
TensorBytes tensor_bytes(const NetworkDescription& network, nlohmann::json& list);

}  // namespace patina::test
