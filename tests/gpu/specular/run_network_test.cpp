#include "passes/specular/run_network.h"

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/gpu/gpu_test.h"
#include "tests/reference/specular/network.h"
#include "tools/bench/random_network.h"

namespace patina::run_network_test {
namespace {

using reference::Activations;

/// What the network gives, by plain loops.
Activations expected(const NetworkDescription& network, Activations values) {
    for (const NetworkLayer& layer : network.layers) {
        switch (layer.kind) {
            case LayerKind::kConv:
                values = reference::convolve(values, layer.weight, layer.bias, layer.pad, layer.relu);
                break;
            case LayerKind::kMaxPool: values = reference::max_pool(values); break;
            case LayerKind::kSamplePool: values = reference::pool_samples(values, network.samples); break;
            case LayerKind::kFull: values = reference::connect(values, layer.weight, layer.bias, layer.relu); break;
        }
    }
    return values;
}

Activations random_images(const NetworkDescription& network, uint32_t segments, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> level(0, 1);
    Activations images(size_t{segments} * network.samples, network.side, network.channels);
    for (double& value : images.values) value = level(random);
    return images;
}

NetworkDescription network_of(uint32_t samples, uint32_t side, uint32_t channels, std::vector<NetworkLayer> layers) {
    NetworkDescription network;
    network.samples = samples;
    network.side = side;
    network.channels = channels;
    network.layers = std::move(layers);
    return with_random_weights(std::move(network), 7);
}

NetworkLayer conv(uint32_t outputs, uint32_t pad, bool relu = true) {
    return {LayerKind::kConv, "conv", outputs, pad, relu};
}
const NetworkLayer kMaxPool{LayerKind::kMaxPool, "max_pool"}, kSamplePool{LayerKind::kSamplePool, "sample_pool"};

/// Of the largest output, in 16-bit floats: their rounding, up to 2^-12, in up to 432 products and sums, by chance
/// (the square root of their number times as much: 0.007 at most; seen: 0.0026). Hardware may cut off, up to 2^-11
/// (seen on an NVIDIA H200: 0.0052).
constexpr double kHalfError = 4e-3, kCutHalfError = 8e-3;
const NetworkVariant kHalves{NetworkFormat::kHalves, 0};

class RunNetwork : public GpuTest {
  protected:
    /// Runs `segments` segments in a batch that has room for `capacity`.
    Activations run_on_gpu(const NetworkDescription& description, const Activations& images, uint32_t segments,
                           uint32_t capacity, const NetworkVariant& variant) {
        Network network(device(), description);
        const ActivationShape in = network.shapes().front(), out = network.shapes().back();
        std::vector<glm::vec4> quads(size_t{capacity} * in.images * in.side * in.side * quads_of(in), glm::vec4(0));
        for (size_t i = 0; i < images.values.size(); ++i) {
            const auto channel = static_cast<uint32_t>(i % in.channels);
            quads[i / in.channels * quads_of(in) + channel / 4][static_cast<int>(channel % 4)] =
                static_cast<float>(images.values[i]);
        }
        std::vector<uint32_t> list(1 + std::max(segments, capacity));
        std::iota(list.begin(), list.end(), 0u);
        list[0] = segments;
        graph::FrameGraph frame = runner().begin();
        const SegmentBatch batch{frame.upload<uint32_t>("batch", list), capacity};
        const graph::Readback result =
            frame.read_back(add_run_network(frame, network, frame.upload<glm::vec4>("images", quads), batch, variant));
        run(std::move(frame));
        return unpack(result.as<glm::vec4>(), out, std::min(segments, capacity));
    }

    static Activations unpack(const std::vector<glm::vec4>& quads, const ActivationShape& shape, size_t segments) {
        Activations result(segments * shape.images, shape.side, shape.channels);
        const uint32_t part = shape.channels / shape.parts;
        for (size_t i = 0; i < result.values.size(); ++i) {
            const auto channel = static_cast<uint32_t>(i % shape.channels), within = channel % part;
            const size_t quad = i / shape.channels * quads_of(shape) + channel / part * quads_of(part) + within / 4;
            result.values[i] = quads[quad][static_cast<int>(within % 4)];
        }
        return result;
    }

    NetworkVariant preferred(const NetworkDescription& network, uint32_t capacity) {
        return preferred_network_variant(device().caps(), Network(device(), network), capacity);
    }

    void expect_agreement(const NetworkDescription& network, uint32_t segments, const NetworkVariant& variant) {
        const Activations images = random_images(network, segments, 3), want = expected(network, images);
        const Activations got = run_on_gpu(network, images, segments, std::max(segments, 1u), variant);
        ASSERT_EQ(got.values.size(), want.values.size());
        const bool halves = variant.format == NetworkFormat::kHalves;
        const double half_error = device().caps().software() ? kHalfError : kCutHalfError;
        double largest = 0, worst = 0;
        for (const double value : want.values) largest = std::max(largest, std::abs(value));
        for (size_t i = 0; i < want.values.size(); ++i) {
            // What cancels out has the rounding errors of its terms.
            const double scale = halves ? largest : std::max(std::abs(want.values[i]), 0.05 * largest);
            const double error = std::abs(got.values[i] - want.values[i]) / scale;
            if (!(error <= worst)) worst = error;  // nor NaN
        }
        EXPECT_LT(worst, halves ? half_error : 1e-4) << "side " << network.side << ", channels " << network.channels
                                                     << ", segments " << segments << (halves ? ", halves" : "");
    }
    void expect_agreement(const NetworkDescription& network, uint32_t segments) {
        expect_agreement(network, segments, preferred(network, std::max(segments, 1u)));
    }
};

TEST_F(RunNetwork, AKernelWithOneTapMovesTheImage) {
    NetworkDescription network = network_of(1, 7, 1, {conv(1, 1, false)});
    network.layers[0].weight.assign(9, 0);
    network.layers[0].weight[5] = 2;  // the pixel to the right
    network.layers[0].bias = {0.25f};
    const Activations images = random_images(network, 1, 1), got = run_on_gpu(network, images, 1, 1, {});
    for (size_t y = 0; y < 7; ++y) {
        for (size_t x = 0; x < 7; ++x) {
            const auto right = static_cast<float>(x < 6 ? images.at(0, x + 1, y, 0) : 0);
            EXPECT_EQ(got.at(0, x, y, 0), 2 * right + 0.25f);
        }
    }
}

TEST_F(RunNetwork, ConvolutionsAgreeWithTheReferenceOnAwkwardShapes) {
    expect_agreement(network_of(3, 1, 33, {conv(5, 1)}), 31);
    expect_agreement(network_of(2, 7, 1, {conv(33, 1, false)}), 1);
    expect_agreement(network_of(2, 15, 3, {conv(16, 1)}), 2);
    expect_agreement(network_of(1, 16, 33, {conv(1, 0)}), 1);
    expect_agreement(network_of(1, 17, 4, {conv(7, 1)}), 1);
}

TEST_F(RunNetwork, ConvolutionsWithPoolingAgreeWithTheReferenceOnAwkwardShapes) {
    expect_agreement(network_of(1, 16, 1, {conv(5, 1), kMaxPool}), 31);
    expect_agreement(network_of(2, 15, 5, {conv(33, 1, false), kMaxPool}), 1);
    expect_agreement(network_of(1, 17, 3, {conv(4, 1), kMaxPool}), 1);
    expect_agreement(network_of(3, 7, 33, {conv(8, 0), kMaxPool}), 3);
}

TEST_F(RunNetwork, PoolingAndFullLayersAgreeWithTheReferenceOnAwkwardShapes) {
    for (const uint32_t side : {7u, 15u, 16u, 17u}) expect_agreement(network_of(3, side, 33, {kMaxPool, kMaxPool}), 2);
    for (const uint32_t channels : {1u, 4u, 33u}) {
        for (const uint32_t segments : {1u, 31u}) {
            expect_agreement(network_of(25, 1, channels, {kSamplePool}), segments);
            expect_agreement(
                network_of(5, 1, channels,
                           {kSamplePool, {LayerKind::kFull, "full1", 33, 0, true}, {LayerKind::kFull, "full2", 1}}),
                segments);
        }
    }
}

TEST_F(RunNetwork, TheWholeNetworkAgreesWithTheReference) { expect_agreement(random_hemi_network(1), 1); }

TEST_F(RunNetwork, TheWholeNetworkAgreesWithTheReferenceThroughStorageBuffers) {
    expect_agreement(random_hemi_network(1), 2, NetworkVariant{});
}

TEST_F(RunNetwork, ManyInvocationsOfSmallTilesGiveTheSameBytes) {
    const NetworkDescription network = random_hemi_network(3);
    const Activations images = random_images(network, 2, 7);
    const auto with = [&](uint32_t least_invocations) {
        return run_on_gpu(network, images, 2, 2, {NetworkFormat::kFloats, least_invocations}).values;
    };
    const auto large_tiles = with(0);
    ASSERT_EQ(large_tiles.size(), 14u);
    for (const uint32_t invocations : {1u << 14, 1u << 16, 1u << 30})
        EXPECT_EQ(with(invocations), large_tiles) << invocations;
}

TEST_F(RunNetwork, SmallTilesAgreeWithTheReferenceOnAwkwardShapes) {
    const NetworkVariant small{NetworkFormat::kFloats, 1u << 30};
    expect_agreement(network_of(2, 7, 1, {conv(33, 1, false)}), 1, small);
    expect_agreement(network_of(1, 17, 3, {conv(4, 1), kMaxPool}), 1, small);
    expect_agreement(network_of(3, 1, 33, {conv(5, 1)}), 31, small);
}

TEST_F(RunNetwork, HalvesAgreeWithTheReferenceOnAwkwardShapes) {
    if (!device().caps().float16) GTEST_SKIP() << "the device lacks shaderFloat16";
    expect_agreement(network_of(3, 1, 33, {conv(5, 1)}), 31, kHalves);
    expect_agreement(network_of(2, 7, 1, {conv(33, 1, false)}), 1, kHalves);
    expect_agreement(network_of(3, 15, 33, {kMaxPool, kMaxPool}), 2, kHalves);
    expect_agreement(network_of(25, 1, 33, {kSamplePool}), 31, kHalves);
    expect_agreement(network_of(2, 16, 5, {conv(8, 1), kMaxPool, conv(5, 0), kMaxPool, kMaxPool}), 3, kHalves);
    for (const uint32_t least_invocations : {0u, 1u << 30})
        expect_agreement(random_hemi_network(1), 2, {NetworkFormat::kHalves, least_invocations});
}

TEST_F(RunNetwork, WeightsThatHalvesCannotHoldAreTold) {
    NetworkDescription network = network_of(5, 1, 4, {kSamplePool, {LayerKind::kFull, "full", 7}});
    EXPECT_TRUE(Network(device(), network).fits_halves());
    network.layers[1].bias[3] = -65505;
    EXPECT_FALSE(Network(device(), network).fits_halves());
}

TEST_F(RunNetwork, HardwareTakesHalvesWhereItHasThemAndTheyHoldTheWeights) {
    NetworkDescription description = random_hemi_network(1);
    vulkan::DeviceCaps caps = device().caps();
    caps.type = vulkan::DeviceType::kDiscrete;
    const auto format = [&](bool float16) {
        caps.float16 = float16;
        return preferred_network_variant(caps, Network(device(), description), 4).format;
    };
    EXPECT_EQ(format(false), NetworkFormat::kFloats);
    EXPECT_EQ(format(true), NetworkFormat::kHalves);
    description.layers.back().bias[0] = 1e5f;
    EXPECT_EQ(format(true), NetworkFormat::kFloats);
}

TEST_F(RunNetwork, FormatsThatADeviceLacksAreRefused) {
    const Network network(device(), random_hemi_network(1));
    vulkan::DeviceCaps caps = device().caps();
    EXPECT_EQ(network_variant(caps, network, 4, NetworkFormat::kFloats).format, NetworkFormat::kFloats);
    caps.float16 = false;
    caps.max_texel_elements = 1;
    EXPECT_THAT([&] { network_variant(caps, network, 4, NetworkFormat::kHalves); },
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr("has no 16-bit floats")));
    EXPECT_THAT([&] { network_variant(caps, network, 4, NetworkFormat::kTexels); },
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr("texel buffers of at most 1 ")));
    caps.float16 = true;
    NetworkDescription large = random_hemi_network(1);
    large.layers.back().bias[0] = 1e5f;
    EXPECT_THAT([&] { network_variant(caps, Network(device(), large), 4, NetworkFormat::kHalves); },
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr("weights that 16-bit floats cannot hold")));
}

TEST_F(RunNetwork, TheOrderOfSamplesDoesNotMatterAndCopiesOfOneAreAsOne) {
    const NetworkDescription network = random_hemi_network(2);
    const Activations images = random_images(network, 1, 5);
    const size_t pixels = images.values.size() / network.samples;
    Activations reversed = images, copies = images, one(1, network.side, network.channels);
    for (size_t i = 0; i < images.values.size(); ++i) {
        const size_t sample = i / pixels, pixel = i % pixels;
        reversed.values[i] = images.values[(network.samples - 1 - sample) * pixels + pixel];
        copies.values[i] = one.values[pixel] = images.values[pixel];
    }
    NetworkDescription single = network;
    single.samples = 1;
    const NetworkVariant variant = preferred(network, 1);
    const auto run_one = [&](const NetworkDescription& with, const Activations& in) {
        return run_on_gpu(with, in, 1, 1, variant).values;
    };
    const auto forward = run_one(network, images), backward = run_one(network, reversed);
    const auto of_copies = run_one(network, copies), of_one = run_one(single, one);
    ASSERT_EQ(forward.size(), 7u);
    EXPECT_EQ(forward, run_one(network, images)) << "same input, same bytes";
    for (size_t i = 0; i < forward.size(); ++i) {
        EXPECT_NEAR(forward[i], backward[i], 1e-5 * std::abs(forward[i]) + 1e-6);
        EXPECT_NEAR(of_copies[i], of_one[i], 1e-5 * std::abs(of_one[i]) + 1e-6);
        EXPECT_NE(forward[i], of_copies[i]);
    }
}

TEST_F(RunNetwork, ABatchHoldsWhatItsCountSaysAndNoMoreThanItsCapacity) {
    const NetworkDescription network = network_of(5, 1, 4, {kSamplePool, {LayerKind::kFull, "full", 7}});
    const Activations images = random_images(network, 3, 2);
    const auto all = run_on_gpu(network, images, 3, 3, {}).values;
    const auto limited = run_on_gpu(network, images, 1000, 3, {}).values;
    EXPECT_EQ(all, limited);
    EXPECT_TRUE(run_on_gpu(network, images, 0, 3, {}).values.empty());
}

TEST_F(RunNetwork, WhatDoesNotFitIsRefused) {
    Network network(device(), network_of(5, 1, 4, {kSamplePool}));
    graph::FrameGraph frame = runner().begin();
    const graph::BufferId images = frame.create_buffer("images", 5 * 16), list = frame.create_buffer("list", 8);
    EXPECT_THAT(
        [&] {
            add_run_network(frame, network, images, {list, 2}, {});
        },
        ::testing::ThrowsMessage<Error>(::testing::HasSubstr("has images of 80 bytes, a batch of 2 segments")));
    EXPECT_THROW(add_run_network(frame, network, images, {list, 0}, {}), Error);
}

}  // namespace
}  // namespace patina::run_network_test
