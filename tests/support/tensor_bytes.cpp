#include "tests/support/tensor_bytes.h"

namespace patina::test {

void TensorBytes::add(const std::string& name, const std::vector<uint64_t>& shape, const std::vector<float>& values) {
    const size_t begin = data.size();
    data.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    header[name] = {{"dtype", "F32"}, {"shape", shape}, {"data_offsets", {begin, data.size()}}};
}

std::string TensorBytes::joined() const {
    const std::string json = header.dump();
    std::string bytes;
    for (int i = 0; i < 8; ++i) bytes += static_cast<char>(json.size() >> 8 * i & 0xff);
    return bytes + json + data;
}

TensorBytes tensor_bytes(const NetworkDescription& network, nlohmann::json& list) {
    TensorBytes bytes;
    list = {{"input", {network.samples, network.side, network.side, network.channels}},
            {"map", network.map == HemisphereMap::kParabolic ? "parabolic" : "orthogonal"},
            {"layers", nlohmann::json::array()}};
    for (const NetworkLayer& layer : network.layers) {
        const bool convolution = layer.kind == LayerKind::kConv;
        if (!convolution && layer.kind != LayerKind::kFull) {
            list["layers"].push_back({{"kind", layer.kind == LayerKind::kMaxPool ? "max_pool" : "sample_pool"}});
            continue;
        }
        nlohmann::json json{{"kind", convolution ? "conv" : "full"}, {"name", layer.name}, {"relu", layer.relu}};
        if (convolution) json["pad"] = layer.pad;
        list["layers"].push_back(json);
        const uint64_t outputs = layer.outputs, inputs = layer.weight.size() / outputs / (convolution ? 9 : 1);
        bytes.add(layer.name + ".weight",
                  convolution ? std::vector<uint64_t>{outputs, inputs, 3, 3} : std::vector<uint64_t>{outputs, inputs},
                  layer.weight);
        bytes.add(layer.name + ".bias", {outputs}, layer.bias);
    }
    return bytes;
}

}  // namespace patina::test
