#include "reconstruction/session/network_file.h"

#include <set>
#include <span>

#include "engine/core/error.h"
#include "reconstruction/session/tensor_file.h"
#include "sensor/files/json_file.h"
#include "shared/specular/hemi_images.h"
#include "shared/specular/network.h"

namespace patina {

namespace {

using sensor::JsonValue;

constexpr uint32_t kMaterialParameters = 7;

/// The layers of a file, one after the other.
class Reader {
  public:
    explicit Reader(TensorFile&& tensors) : tensors_(std::move(tensors)) {}

    NetworkDescription read() {
        const JsonValue network = description();
        network.expect_keys({"input", "map", "layers"});
        result_.source = tensors_.file;
        result_.map = map_of(network.at("map"));
        check_input(network.at("input"));
        shape_ = {result_.samples, result_.side, result_.channels};
        for (const JsonValue& layer : network.at("layers").elements()) add(layer);
        check_output();
        check_used();
        return std::move(result_);
    }

  private:
    JsonValue description() const {
        const auto found = tensors_.metadata.find("network");
        if (found == tensors_.metadata.end()) throw Error(tensors_.file, ": __metadata__.network is missing");
        const std::string& json = found->second;
        return JsonValue::parse(tensors_.file + ": __metadata__.network",
                                std::span(reinterpret_cast<const uint8_t*>(json.data()), json.size()));
    }

    static HemisphereMap map_of(const JsonValue& value) {
        if (value.string() == "parabolic") return HemisphereMap::kParabolic;
        if (value.string() == "orthogonal") return HemisphereMap::kOrthogonal;
        value.fail("known are: parabolic, orthogonal");
    }

    void check_input(const JsonValue& input) const {
        const std::vector<double> asked{gpu::kHemiSamples, gpu::kHemiSide, gpu::kHemiSide, 3};
        if (input.numbers(asked.size()) == asked) return;
        input.fail(text("must be ", text_of_shape({gpu::kHemiSamples, gpu::kHemiSide, gpu::kHemiSide, 3})));
    }

    static LayerKind kind_of(const JsonValue& value) {
        const std::string kind = value.string();
        if (kind == "conv") return LayerKind::kConv;
        if (kind == "max_pool") return LayerKind::kMaxPool;
        if (kind == "sample_pool") return LayerKind::kSamplePool;
        if (kind == "full") return LayerKind::kFull;
        value.fail("known are: conv, max_pool, sample_pool, full");
    }

    void add(const JsonValue& json) {
        NetworkLayer layer;
        layer.kind = kind_of(json.at("kind"));
        layer.name = json.at("kind").string();
        const bool convolution = layer.kind == LayerKind::kConv;
        if (convolution || layer.kind == LayerKind::kFull) {
            std::vector<std::string> keys{"kind", "name", "relu"};
            if (convolution) keys.push_back("pad");
            json.expect_keys(keys);
            layer.name = json.at("name").string();
            layer.relu = json.at("relu").boolean();
            if (convolution) layer.pad = static_cast<uint32_t>(json.at("pad").whole_number(1));
            take_weights(layer);
        } else {
            json.expect_keys({"kind"});
        }
        shape_ = shape_after(result_, layer, shape_);
        result_.layers.push_back(std::move(layer));
    }

    void take_weights(NetworkLayer& layer) {
        const std::string weight = layer.name + ".weight", bias = layer.name + ".bias";
        const Tensor& weights = tensor(weight);
        const uint64_t outputs = weights.shape.empty() ? 0 : weights.shape.front();
        std::vector<uint64_t> asked{outputs, shape_.channels};
        if (layer.kind == LayerKind::kConv) asked.insert(asked.end(), 2, gpu::kKernelSide);
        check_shape(weight, asked);
        check_shape(bias, {outputs});
        layer.outputs = static_cast<uint32_t>(outputs);
        layer.weight = weights.values;
        layer.bias = tensor(bias).values;
        used_.insert({weight, bias});
    }

    const Tensor& tensor(const std::string& name) const {
        const auto found = tensors_.tensors.find(name);
        if (found == tensors_.tensors.end()) throw Error(tensors_.file, ": ", name, " is missing");
        return found->second;
    }

    void check_shape(const std::string& name, const std::vector<uint64_t>& asked) const {
        const std::vector<uint64_t>& shape = tensor(name).shape;
        if (shape == asked) return;
        throw Error(tensors_.file, ": ", name, ".shape is ", text_of_shape(shape), ", the list of layers asks for ",
                    text_of_shape(asked));
    }

    void check_output() const {
        if (shape_.pooled && shape_.channels == kMaterialParameters) return;
        throw Error(tensors_.file, ": __metadata__.network.layers give ", shape_.channels,
                    shape_.pooled ? " numbers per segment" : " channels per sample", ", a material has ",
                    kMaterialParameters, " numbers per segment");
    }

    void check_used() const {
        for (const auto& [name, unused] : tensors_.tensors) {
            if (!used_.contains(name)) throw Error(tensors_.file, ": ", name, " belongs to none of the layers");
        }
    }

    TensorFile tensors_;
    NetworkDescription result_;
    ActivationShape shape_;  ///< after the layers so far
    std::set<std::string> used_;
};

}  // namespace

NetworkDescription read_network_file(const std::filesystem::path& file) {
    return Reader(read_tensor_file(file)).read();
}

}  // namespace patina
