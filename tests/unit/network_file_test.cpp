#include "reconstruction/session/network_file.h"

#include <cstring>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "reconstruction/session/tensor_file.h"
#include "sensor/files/text_file.h"
#include "tests/export/temporary_folder.h"
#include "tests/export/throws.h"
#include "tests/support/tensor_bytes.h"
#include "tools/bench/random_network.h"

namespace patina::tools::network_file_test {
namespace {

using nlohmann::json;
using test::TensorBytes;
using test::throws_error_with;

class NetworkFile : public ::testing::Test {
  protected:
    /// A network small enough that its numbers can be told.
    static NetworkDescription small() {
        NetworkDescription network;
        network.layers = {{LayerKind::kConv, "conv1", 2, 1, true}, {LayerKind::kMaxPool, ""},
                          {LayerKind::kConv, "conv2", 3, 1, true}, {LayerKind::kMaxPool, ""},
                          {LayerKind::kConv, "conv3", 4, 0, true}, {LayerKind::kSamplePool, ""},
                          {LayerKind::kFull, "full1", 7}};
        return with_random_weights(std::move(network), 3);
    }

    void write(const std::string& bytes) const { sensor::write_bytes(file_, bytes); }
    void write(TensorBytes bytes, const json& list) const {
        bytes.header["__metadata__"]["network"] = list.dump();
        write(bytes.joined());
    }

    /// Expects the file's name and `part` of the error after a change to its header, data or list of layers.
    void expect_error(const std::function<void(TensorBytes&, json&)>& spoil, const std::string& part) const {
        json list;
        TensorBytes bytes = test::tensor_bytes(small(), list);
        spoil(bytes, list);
        write(std::move(bytes), list);
        EXPECT_THAT([&] { read_network_file(file_); }, throws_error_with(file_.string() + ": " + part));
    }

    test::TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "net.safetensors";
};

TEST_F(NetworkFile, WhatWasWrittenIsRead) {
    NetworkDescription network = random_hemi_network(4);
    network.map = HemisphereMap::kOrthogonal;
    json list;
    write(test::tensor_bytes(network, list), list);
    const NetworkDescription read = read_network_file(file_);
    EXPECT_EQ(read.source, file_.string());
    EXPECT_EQ(read.map, HemisphereMap::kOrthogonal);
    ASSERT_EQ(read.layers.size(), network.layers.size());
    size_t parameters = 0;
    for (size_t i = 0; i < read.layers.size(); ++i) {
        EXPECT_EQ(read.layers[i].kind, network.layers[i].kind);
        EXPECT_EQ(read.layers[i].outputs, network.layers[i].outputs);
        EXPECT_EQ(read.layers[i].pad, network.layers[i].pad);
        EXPECT_EQ(read.layers[i].relu, network.layers[i].relu);
        EXPECT_EQ(read.layers[i].weight, network.layers[i].weight);
        EXPECT_EQ(read.layers[i].bias, network.layers[i].bias);
        parameters += read.layers[i].weight.size() + read.layers[i].bias.size();
    }
    EXPECT_EQ(parameters, 71895u);
    EXPECT_EQ(activation_shapes(read), activation_shapes(network));
    EXPECT_LT(std::filesystem::file_size(file_), 340000u);
}

TEST_F(NetworkFile, ATruncatedFileIsRefused) {
    json list;
    TensorBytes bytes = test::tensor_bytes(small(), list);
    bytes.header["__metadata__"]["network"] = list.dump();
    const std::string whole = bytes.joined();
    write(whole.substr(0, 5));
    EXPECT_THAT([&] { read_network_file(file_); },
                throws_error_with(": the header's length takes 8 bytes, the file has 5"));
    write(whole.substr(0, 100));
    EXPECT_THAT([&] { read_network_file(file_); }, throws_error_with(" bytes, the file has 92 behind it"));
    write(whole.substr(0, whole.size() - 1));
    EXPECT_THAT([&] { read_network_file(file_); }, throws_error_with("data_offsets[1] is "));
    write(whole + "x");
    EXPECT_THAT([&] { read_network_file(file_); }, throws_error_with(": the tensors end at "));
    EXPECT_THROW(read_network_file(folder_ / "none"), Error);
}

TEST_F(NetworkFile, AHeaderThatIsNoneIsRefused) {
    std::string huge(16, ' ');
    const uint64_t length = (1 << 20) + 1;
    std::memcpy(huge.data(), &length, 8);
    write(huge + std::string(length, ' '));
    EXPECT_THAT([&] { read_network_file(file_); },
                throws_error_with(": the header's length is 1048577 bytes, at most 1048576 are read"));
    std::string endless(16, '\xff');
    write(endless);
    EXPECT_THAT([&] { read_network_file(file_); }, throws_error_with("is 18446744073709551615 bytes, at most"));
    write(std::string("\x02\0\0\0\0\0\0\0{x", 10));
    EXPECT_THAT([&] { read_network_file(file_); }, throws_error_with(" is not valid JSON"));
    write(std::string("\x02\0\0\0\0\0\0\0[]", 10));
    EXPECT_THAT([&] { read_network_file(file_); }, throws_error_with("must be an object"));
}

TEST_F(NetworkFile, TensorsThatDisagreeWithThemselvesAreRefused) {
    expect_error([](TensorBytes& bytes, json&) { bytes.header["conv1.bias"]["dtype"] = "BF16"; },
                 "conv1.bias.dtype is \"BF16\", must be \"F32\"");
    expect_error([](TensorBytes& bytes, json&) { bytes.header["conv1.bias"]["shape"] = {3}; },
                 "conv1.bias.shape is [3], takes 12 bytes, its data_offsets are 8 apart");
    expect_error(
        [](TensorBytes& bytes, json&) {
            bytes.header["conv1.bias"]["shape"] = {4294967295, 4294967295, 9};
        },
        "conv1.bias.shape is [4294967295,4294967295,9], takes ");
    expect_error([](TensorBytes& bytes, json&) { bytes.header["conv1.bias"]["shape"] = {-2}; },
                 "conv1.bias.shape[0] is -2");
    expect_error([](TensorBytes& bytes, json&) { bytes.header["conv1.bias"].erase("shape"); },
                 "conv1.bias.shape is missing");
    expect_error([](TensorBytes& bytes, json&) { bytes.header["conv1.bias"]["color"] = "red"; },
                 "conv1.bias.color is \"red\", an unknown key");
    expect_error(
        [](TensorBytes& bytes, json&) {
            bytes.header["conv1.bias"]["data_offsets"] = {8, 0};
        },
        "conv1.bias.data_offsets is [8,0], must not end before it begins");
    expect_error(
        [](TensorBytes& bytes, json&) {
            bytes.header["conv1.bias"]["data_offsets"] = {0, 1 << 30};
        },
        "conv1.bias.data_offsets[1] is 1073741824, must be a whole number from 0 to ");
}

TEST_F(NetworkFile, TensorsThatDoNotLieSideBySideAreRefused) {
    expect_error(
        [](TensorBytes& bytes, json&) {
            bytes.header["conv1.bias"]["data_offsets"] = {208, 216};
        },
        "conv1.bias.data_offsets begin at 208, conv1.weight ends at 216: they overlap");
    expect_error([](TensorBytes& bytes, json&) { bytes.header.erase("conv1.bias"); },
                 "conv2.weight.data_offsets begin at 224, conv1.weight ends at 216: there is a gap");
}

TEST_F(NetworkFile, WeightsThatAreNotFiniteAreRefused) {
    for (const float wild : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        expect_error([&](TensorBytes& bytes, json&) { std::memcpy(bytes.data.data() + 4 * 5, &wild, 4); },
                     text("conv1.weight: element 5 is ", wild, ", must be finite"));
    }
}

TEST_F(NetworkFile, AListOfLayersThatIsWrongIsRefused) {
    const std::string where = "__metadata__.network: ";
    expect_error([](TensorBytes&, json& list) { list["layers"][1]["kind"] = "softmax"; },
                 where + "layers[1].kind is \"softmax\", known are: conv, max_pool, sample_pool, full");
    expect_error([](TensorBytes&, json& list) { list["map"] = "fisheye"; }, where + "map is \"fisheye\"");
    expect_error([](TensorBytes&, json& list) { list["input"][0] = 24; },
                 where + "input is [24,15,15,3], must be [25, 15, 15, 3]");
    expect_error([](TensorBytes&, json& list) { list["layers"][0]["pad"] = 2; },
                 where + "layers[0].pad is 2, must be a whole number from 0 to 1");
    expect_error([](TensorBytes&, json& list) { list["layers"][0]["stride"] = 2; },
                 where + "layers[0].stride is 2, an unknown key");
    expect_error([](TensorBytes&, json& list) { list.erase("layers"); }, where + "layers is missing");
    json list;
    write(test::tensor_bytes(small(), list).joined());
    EXPECT_THAT([&] { read_network_file(file_); }, throws_error_with(": __metadata__.network is missing"));
}

TEST_F(NetworkFile, TensorsThatTheLayersDoNotAskForAreRefused) {
    expect_error(
        [](TensorBytes& bytes, json&) {
            bytes.header["conv2.weight"]["shape"] = {2, 3, 3, 3};
        },
        "conv2.weight.shape is [2, 3, 3, 3], the list of layers asks for [2, 2, 3, 3]");
    expect_error([](TensorBytes&, json& list) { list["layers"][2]["name"] = "conv9"; }, "conv9.weight is missing");
    expect_error([](TensorBytes& bytes, json&) { bytes.add("extra", {1}, {1}); },
                 "extra belongs to none of the layers");
}

TEST_F(NetworkFile, LayersThatCannotFollowOneAnotherAreRefused) {
    const auto erase = [](size_t layer) { return [=](TensorBytes&, json& list) { list["layers"].erase(layer); }; };
    expect_error(erase(5), "full1.weight.shape is [7, 8], the list of layers asks for [7, 4]");
    expect_error(erase(1), "layer 'sample_pool' needs images of 1 pixel a side and gets 5");
    expect_error(
        [](TensorBytes&, json& list) {
            list["layers"][0] = {{"kind", "sample_pool"}};
        },
        "layer 'sample_pool' needs images of 1 pixel a side and gets 15");
    expect_error(
        [](TensorBytes&, json& list) {
            list["layers"].push_back({{"kind", "max_pool"}});
        },
        "layer 'max_pool' must come before the samples are pooled");
    expect_error([](TensorBytes&, json& list) { list["layers"].erase(6); },
                 "__metadata__.network.layers give 8 numbers per segment, a material has 7 numbers per segment");
}

}  // namespace
}  // namespace patina::tools::network_file_test
