#include <algorithm>
#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "passes/specular/run_network.h"
#include "reconstruction/session/network_file.h"
#include "reconstruction/session/tensor_file.h"
#include "shared/specular/hemi_images.h"
#include "shared/specular/specular_estimates.h"
#include "tests/gpu/gpu_test.h"

namespace patina::trained_network_test {
namespace {

const std::filesystem::path kFile = PATINA_SOURCE_DIR "/assets/hemicnn.safetensors";

/// The images that the file's own check is about: docs/guide/training.md.
std::vector<glm::vec4> check_images(size_t segments) {
    std::vector<glm::vec4> pixels(segments * gpu::kHemiSamples * gpu::kHemiPixels, glm::vec4(0));
    for (size_t i = 0; i < pixels.size() * 3; ++i) {
        const auto word = static_cast<uint32_t>(i * 2654435761u);
        pixels[i / 3][static_cast<int>(i % 3)] = static_cast<float>(word >> 20) / 4096;
    }
    return pixels;
}

TEST(TrainedNetworkFile, IsTheDocumentedNetworkAndSmall) {
    EXPECT_LT(std::filesystem::file_size(kFile), 340u * 1000);
    const NetworkDescription network = patina::read_network_file(kFile);
    size_t parameters = 0;
    for (const NetworkLayer& layer : network.layers) parameters += layer.weight.size() + layer.bias.size();
    EXPECT_EQ(parameters, 71895u);
    EXPECT_EQ(network.map, HemisphereMap::kParabolic);
}

class TrainedNetwork : public GpuTest {
  protected:
    /// The largest difference from what the file says that it gives.
    double largest_error(NetworkFormat format) {
        const nlohmann::json want = nlohmann::json::parse(patina::read_tensor_file(kFile).metadata.at("check"));
        const auto segments = static_cast<uint32_t>(want.size());
        Network network(device(), patina::read_network_file(kFile));
        std::vector<uint32_t> list(1 + segments);
        list[0] = segments;
        graph::FrameGraph frame = runner().begin();
        const SegmentBatch batch{frame.upload<uint32_t>("batch", list), segments};
        const graph::BufferId images = frame.upload<glm::vec4>("images", check_images(segments));
        const NetworkVariant variant = network_variant(device().caps(), network, segments, format);
        const graph::Readback result = frame.read_back(add_run_network(frame, network, images, batch, variant));
        run(std::move(frame));
        const auto got = result.as<gpu::PerceptualMaterial>();
        double largest = segments == 0 ? INFINITY : 0;
        for (uint32_t i = 0; i < segments; ++i) {
            const float w[7] = {got[i].lab_cr.x,       got[i].lab_cr.y,       got[i].lab_cr.z,      got[i].lab_cr.w,
                                got[i].cgb_d_weight.x, got[i].cgb_d_weight.y, got[i].cgb_d_weight.z};
            for (size_t k = 0; k < 7; ++k) {
                const double error = std::abs(w[k] - want[i][k].get<double>());
                if (!(error <= largest)) largest = error;  // nor NaN
            }
        }
        return largest;
    }
};

TEST_F(TrainedNetwork, GivesWhatItGaveWhereItWasTrained) {
    EXPECT_LT(largest_error(NetworkFormat::kFloats), 1e-4);
    if (device().caps().max_texel_elements >= 1u << 20) {
        EXPECT_LT(largest_error(NetworkFormat::kTexels), 1e-4);
    }
}

TEST_F(TrainedNetwork, GivesNearlyThatInHalves) {
    if (!device().caps().float16) GTEST_SKIP() << "the device lacks shaderFloat16";
    const double error = largest_error(NetworkFormat::kHalves);
    EXPECT_LT(error, 4e-3) << "twice what NetworkVariant says";
    EXPECT_GT(error, 1e-5) << "16-bit floats cannot be as exact as that";
}

}  // namespace
}  // namespace patina::trained_network_test
