// Views of a finished model show what pictures saw of it.

#include "reconstruction/texture/shown_pictures.h"

#include "engine/core/srgb.h"
#include "reconstruction/pipeline.h"
#include "reconstruction/session/rgbd_frame.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"
#include "tests/gpu/gpu_test.h"

namespace patina::shown_pictures_test {
namespace {

class ShownPicturesTest : public GpuTest {
  protected:
    static constexpr uint32_t kFrames = 4;

    ShownPicturesTest() : pipeline_(device(), settings()) {
        scenes::SyntheticScene scene = scenes::load_scene("balls");
        scene.camera = scaled_to(scene.camera, {128, 106});
        scenes::SyntheticSource source(device(), std::move(scene), {.frames = kFrames});
        info_ = source.info();
        lights_ = source.scene().lights;
        pipeline_.set_lights(lights_);
        while (auto reading = source.next()) {
            frames_.push_back(std::get<Frame>(std::move(*reading)));
            if (frames_.size() - 1 != kSeen) pipeline_.add(patina::to_rgbd(info_, frames_.back()));
        }
    }

    static ReconstructionSettings settings() {
        ReconstructionSettings settings;
        settings.map.voxel_m = 0.02f;
        settings.fusion.truncation_m = 0.06f;
        settings.segmentation.emplace();
        settings.reflectance.emplace();
        settings.reflectance->voxel_m = 0.04f;
        return settings;
    }

    void give(const std::vector<uint32_t>& frames, size_t count) {
        pipeline_.show_pictures(info_.color, count, [&](const Pipeline::TakePicture& take) {
            for (const uint32_t index : frames) {
                TexturePicture picture;
                std::visit([&](const auto& image) { picture.color.pixels = std::span(image.pixels()); },
                           frames_[index].color);
                picture.color.camera = info_.color;
                picture.world_from_camera = color_pose(index);
                take(picture);
            }
        });
    }

    RigidTransform color_pose(uint32_t index) const {
        return *frames_[index].world_from_camera * rigid_inverse(info_.color_from_depth);
    }

    ModelView::Reflectance view() {
        const ViewReadback pending = pipeline_.view(info_.color, color_pose(kSeen));
        pipeline_.wait();
        return *pending.get().reflectance;
    }

    /// Mean squared difference from what the camera saw there, where the model knows of something.
    double error_of(const Image<glm::vec4>& rgb) const {
        double sum = 0, known = 0;
        for (size_t i = 0; i < rgb.pixels().size(); ++i) {
            const glm::vec3 seen = linear_color(std::get<Image<SrgbPixel>>(frames_[kSeen].color).pixels()[i]);
            const glm::vec3 off = glm::vec3(rgb.pixels()[i]) - seen;
            sum += rgb.pixels()[i].a > 0 ? glm::dot(off, off) : 0;
            known += rgb.pixels()[i].a > 0;
        }
        return sum / known;
    }

    static constexpr uint32_t kSeen = 1;  // neither fused nor given
    SequenceInfo info_;
    std::vector<Frame> frames_;
    std::vector<Light> lights_;
    Pipeline pipeline_;
};

size_t differing(const Image<glm::vec4>& a, const Image<glm::vec4>& b) {
    size_t count = 0;
    for (size_t i = 0; i < a.pixels().size(); ++i) count += a.pixels()[i] != b.pixels()[i];
    return count;
}

TEST_F(ShownPicturesTest, ViewsComeNearerToWhatTheCameraSaw) {
    pipeline_.refine_all();
    const ModelView::Reflectance before = view();
    give({0, 3}, 2);
    const ModelView::Reflectance after = view();
    EXPECT_LT(error_of(after.rgb), 0.7 * error_of(before.rgb));
    EXPECT_EQ(differing(after.model_rgb, before.model_rgb), 0u) << "the model is what it was";
}

TEST_F(ShownPicturesTest, UnderOtherLightTheirAlbedoIsShown) {
    pipeline_.refine_all();
    give({0, 3}, 2);
    const ModelView::Reflectance before = view();
    for (Light& light : lights_) light.intensity *= 0.5;
    pipeline_.relight({.lights = lights_, .far_field = {}});
    const ModelView::Reflectance after = view();
    EXPECT_GT(differing(after.rgb, after.model_rgb), 1000u);
    size_t alike = 0, shown = 0;
    for (size_t i = 0; i < after.kd.pixels().size(); ++i) {
        if (after.kd.pixels()[i] == after.model_kd.pixels()[i]) continue;
        ++shown;
        alike += glm::distance(after.kd.pixels()[i], before.kd.pixels()[i]) < 0.02f;
    }
    EXPECT_GT(shown, 1000u);
    EXPECT_GT(alike, shown * 9 / 10) << "as under the light of the frames";
}

TEST_F(ShownPicturesTest, OfMoreThanFitSomeAreShown) {
    pipeline_.refine_all();
    const ModelView::Reflectance before = view();
    // Every second one of these fits: frame 0 alone is taken.
    give({0, 3}, 2 * ShownPictures::most_of(info_.color));
    const ModelView::Reflectance first = view();
    give({0}, 1);
    EXPECT_EQ(differing(first.rgb, view().rgb), 0u);
    EXPECT_GT(differing(first.rgb, before.rgb), 2000u);
    give({}, 0);
    EXPECT_EQ(differing(before.rgb, view().rgb), 0u) << "none are shown any more";
}

}  // namespace
}  // namespace patina::shown_pictures_test
