#include "tests/eval/eval_rig.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "export/write_exr.h"
#include "sensor/files/picture_file.h"
#include "sensor/files/text_file.h"
#include "tests/eval/pictures.h"

namespace patina::test {
namespace {

namespace fs = std::filesystem;

const std::set<std::string> kOnlyInRuns = {"kd_segment", "rgb_segment", "kd_shown", "rgb_shown"};

uint32_t object_at(uint32_t index, uint32_t x, uint32_t y) {
    if (x < 7 && y < 9) return 3;
    if (y < 10) return 0;
    return index != 20 && x >= 20 && x < 40 && y >= 15 && y < 33 ? 2 : 1;
}

glm::vec3 true_kd(uint32_t object, uint32_t x, uint32_t y) {
    if (object != 2) return {0.6f, 0.5f, 0.4f};
    return glm::vec3(0.3f, 0.4f, 0.5f) + 0.1f * std::sin(0.7f * static_cast<float>(x) + 0.4f * static_cast<float>(y));
}

fs::path exr_file(const fs::path& folder, uint32_t index) {
    return folder / "frames" / (sensor::picture_stem(index) + ".exr");
}

}  // namespace

void write_frame(const fs::path& file, const EvalFrame& frame, const std::set<std::string>& without) {
    std::vector<ExrChannel> channels;
    const auto add = [&](const std::string& group, const std::vector<ExrChannel>& group_channels) {
        if (!without.contains(group)) channels.insert(channels.end(), group_channels.begin(), group_channels.end());
    };
    const std::pair<const char*, const Image<glm::vec3>*> colors[] = {{"kd", &frame.kd},
                                                                      {"kd_segment", &frame.kd_segment},
                                                                      {"ks", &frame.ks},
                                                                      {"rgb", &frame.rgb},
                                                                      {"rgb_segment", &frame.rgb_segment},
                                                                      {"kd_shown", &frame.kd_shown},
                                                                      {"rgb_shown", &frame.rgb_shown}};
    const std::pair<const char*, const Image<float>*> scalars[] = {
        {"alpha", &frame.alpha}, {"depth", &frame.depth}, {"label", &frame.label}, {"valid", &frame.valid}};
    for (const auto& [name, image] : colors) add(name, rgb_channels(name, *image));
    for (const auto& [name, image] : scalars) add(name, {scalar_channel(name, *image)});
    add("normal", xyz_channels("normal", frame.normal));
    write_exr(file, channels);
}

EvalFrame EvalRig::frame(uint32_t index) {
    const auto object = [&](uint32_t x, uint32_t y) { return object_at(index, x, y); };
    EvalFrame frame;
    frame.label = picture_of<float>(kExtent, object);
    frame.valid = picture_of<float>(kExtent, [&](auto x, auto y) { return object(x, y) > 0 ? 1 : 0; });
    frame.kd = picture_of<glm::vec3>(kExtent, [&](auto x, auto y) { return true_kd(object(x, y), x, y); });
    frame.ks = Image<glm::vec3>(kExtent, glm::vec3(0.1f, 0.15f, 0.2f));
    frame.alpha =
        picture_of<float>(kExtent, [&](auto x, auto y) { return 0.1f + 0.1f * static_cast<float>(object(x, y)); });
    frame.depth = picture_of<float>(kExtent, [&](auto, auto y) { return 2 + 0.02f * static_cast<float>(y); });
    frame.normal = Image<glm::vec3>(kExtent, glm::vec3(0, -0.6f, -0.8f));
    // Beyond 1 in the upper rows, where a recorded picture is clipped.
    frame.rgb = picture_of<glm::vec3>(
        kExtent, [&](auto x, auto y) { return true_kd(object(x, y), x, y) * (2.5f - 0.05f * static_cast<float>(y)); });
    frame.kd_segment = frame.kd_shown = frame.kd;
    frame.rgb_segment = frame.rgb_shown = frame.rgb;
    return frame;
}

std::vector<sensor::StampedPose> EvalRig::trajectory() {
    std::vector<sensor::StampedPose> poses;
    for (uint32_t i = 0; i < kFrames; ++i) {
        const double t = i / 30.0;
        const auto place = glm::translate(RigidTransform(1), glm::dvec3(std::sin(t), -1.5, std::cos(2 * t)));
        poses.push_back({t, glm::rotate(place, 0.5 * t, glm::dvec3(0, 1, 0))});
    }
    return poses;
}

std::vector<Light> EvalRig::lights() { return {{{0, -2.5, 1}, {3, 3, 3}}, {{2, -2.5, -1}, {2, 1.5, 1}}}; }

EvalRig::EvalRig() {
    const fs::path truth = sequence() / "truth";
    fs::create_directories(truth / "frames");
    fs::create_directories(run() / "frames");
    for (uint32_t i = 0; i < kFrames; i += kEvery) write_frame(exr_file(truth, i), frame(i), kOnlyInRuns);
    change_frames([](EvalFrame&) {});
    for (const fs::path& folder : {truth, run()}) {
        sensor::write_trajectory(folder / "trajectory.txt", trajectory());
        sensor::write_lights(folder / "lights.json", lights());
    }
    sensor::write_bytes(run() / "run.json", "{}");
    sensor::write_materials(
        truth / "materials.json",
        std::vector<sensor::Material>{{1, "floor", glm::dvec3(0.6, 0.5, 0.4), {0.1, 0.15, 0.2}, 0.2},
                                      {2, "box", {}, {0.1, 0.15, 0.2}, 0.3}});
}

fs::path EvalRig::run_frame(uint32_t index) const { return exr_file(run(), index); }

void EvalRig::change_frames(const std::function<void(EvalFrame&)>& change, const std::set<std::string>& without) const {
    for (uint32_t i = 0; i < kFrames; i += kEvery) {
        EvalFrame changed = frame(i);
        change(changed);
        write_frame(run_frame(i), changed, without);
    }
}

}  // namespace patina::test
