#include <algorithm>
#include <cstring>

#include "passes/specular/perceptual.h"
#include "scenes/description/example_scene.h"
#include "tests/cli/run_folder.h"
#include "tools/synth/example_file.h"

namespace patina::testing::synth_hemi_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using tools::ExampleFileHeader;
using tools::ExampleLabel;

class SynthHemi : public RunFolderTest {
  protected:
    /// Writes 70 examples, a batch and a bit; returns the file's bytes.
    std::string bytes_of(const std::string& name, const std::string& seed) {
        const Outcome outcome =
            patina({"synth-hemi", "--seed", seed, "--examples", "70", "--out", beside(name).string(), "--quiet"});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return read_text(beside(name));
    }

    template <class Value>
    static Value read_at(const std::string& bytes, size_t offset) {
        Value value;
        std::memcpy(&value, bytes.data() + offset, sizeof(value));
        return value;
    }
};

TEST_F(SynthHemi, WritesTheSameFileForTheSameSeed) {
    const std::string one = bytes_of("one.hemi", "3"), again = bytes_of("again.hemi", "3");
    EXPECT_TRUE(one == again);
    EXPECT_FALSE(one == bytes_of("other.hemi", "4"));
}

TEST_F(SynthHemi, LabelsAreTheMaterialsOfTheScenes) {
    const std::string bytes = bytes_of("one.hemi", "3");
    const auto header = read_at<ExampleFileHeader>(bytes, 0);
    EXPECT_EQ(std::string(header.magic), "PATHEMI");
    EXPECT_EQ(header.seed, 3u);
    EXPECT_EQ(header.examples, 70u);
    ASSERT_EQ(bytes.size(), sizeof(header) + 70 * header.example_bytes);
    uint64_t scene = 0;
    for (size_t i = 0; i < 70; ++i, ++scene) {
        const auto label = read_at<ExampleLabel>(bytes, sizeof(header) + i * header.example_bytes);
        // Scenes of which nothing was seen are left out.
        const auto alpha = [&] { return scenes::draw_example_material(3, scene, 0).ks_alpha.w; };
        while (alpha() != label.alpha && scene < 100) ++scene;
        const gpu::WardMaterial material = scenes::draw_example_material(3, scene, 0);
        EXPECT_EQ(glm::vec3(label.kd[0], label.kd[1], label.kd[2]), glm::vec3(material.kd_weight)) << i;
        EXPECT_EQ(glm::vec3(label.ks[0], label.ks[1], label.ks[2]), glm::vec3(material.ks_alpha)) << i;
        const Perceptual w =
            perceptual_of({glm::dvec3(material.kd_weight), glm::dvec3(material.ks_alpha), double{material.ks_alpha.w}});
        for (size_t k = 0; k < w.size(); ++k) EXPECT_NEAR(label.w[k], w[k], 1e-6) << i << ", " << k;
    }
    EXPECT_LT(scene, 80u);
}

TEST_F(SynthHemi, WritesOverNothing) {
    bytes_of("one.hemi", "3");
    const Outcome outcome = patina({"synth-hemi", "--examples", "1", "--out", beside("one.hemi").string()});
    EXPECT_THAT(expect_failure(outcome), AllOf(HasSubstr("one.hemi"), HasSubstr("exists already")));
}

}  // namespace
}  // namespace patina::testing::synth_hemi_test
