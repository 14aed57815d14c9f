#include "tests/gpu/segmentation/label_rig.h"

#include "engine/core/shader_camera.h"

namespace patina {

std::vector<uint32_t> random_roots(uint32_t labels, std::mt19937& random) {
    std::vector<uint32_t> roots(labels);
    for (uint32_t label = 1; label < labels; ++label) {
        const uint32_t smaller = roots[random() % label];
        roots[label] = random() % 2 == 0 ? label : random() % 2 == 0 ? smaller : 0;
    }
    return roots;
}

LabelRig::LabelRig(vulkan::Device& device, graph::Runner& runner)
    : runner_(runner), fusion_(device, runner, {0.01f, kCapacity}, {.max_depth_m = 2}), labels_(device, fusion_.map()) {
    for (int i = 0; i < 4; ++i) fusion_.fuse(camera(), RigidTransform(1), depth_m(RigidTransform(1)));
}

const Intrinsics& LabelRig::camera() {
    static const Intrinsics kCamera{{96, 64}, 90, 90, 47.5, 31.5, {}};
    return kCamera;
}

const reference::DistanceField& LabelRig::scene() {
    static const reference::DistanceField kScene = [](glm::dvec3 p) {
        return std::min(reference::sphere({0.05, 0, 0.8}, 0.15)(p), kWallM - p.z);
    };
    return kScene;
}

Image<float> LabelRig::depth_m(const RigidTransform& world_from_camera) {
    return reference::render_depth(scene(), camera(), world_from_camera, 2);
}

std::vector<uint32_t> LabelRig::read(graph::BufferId LabelMapIds::*buffer) {
    graph::FrameGraph frame = runner_.begin();
    const graph::Readback read = frame.read_back(labels_.import(frame).*buffer);
    runner_.submit(std::move(frame));
    runner_.wait();
    return read.as<uint32_t>();
}

std::vector<uint32_t> LabelRig::words() { return read(&LabelMapIds::words); }
std::vector<uint32_t> LabelRig::stamps() { return read(&LabelMapIds::stamps); }

void LabelRig::set(const std::vector<uint32_t>& words, const std::vector<uint32_t>& stamps) {
    graph::FrameGraph frame = runner_.begin();
    LabelMapIds ids = labels_.import(frame);
    ids.words = frame.upload_bytes(ids.words, 0, std::as_bytes(std::span(words)), true);
    ids.stamps = frame.upload_bytes(ids.stamps, 0, std::as_bytes(std::span(stamps)), true);
    LabelMap::keep(frame, ids);
    runner_.submit(std::move(frame));
}

void LabelRig::set_random(std::mt19937& random, uint32_t empty_of_8) {
    std::vector<uint32_t> words(size_t{kCapacity} * gpu::kBlockVoxels);
    for (uint32_t& word : words) {
        if (random() % 8 < empty_of_8) continue;
        const uint32_t most = random() % 2 == 0 ? 4 : 255;  // half of them fall to one or two votes
        word = label_word(
            {1 + static_cast<uint32_t>(random() % (kLabels - 1)), 1 + static_cast<uint32_t>(random() % most)});
    }
    set(words, std::vector<uint32_t>(kCapacity, 1));
}

reference::LabelVolume LabelRig::volume() {
    const std::vector<uint32_t> words = this->words(), keys = fusion_.table().block_keys;
    reference::LabelVolume volume{map().settings().voxel_m, {}};
    for (uint32_t block = 0; block < keys.size(); ++block) {
        if (keys[block] == gpu::kEmptyKey) continue;
        std::vector<reference::VoxelLabel>& labels = volume.blocks[coordinates_of_key(keys[block])];
        for (size_t i = 0; i < gpu::kBlockVoxels; ++i) labels.push_back(label_of(words[block * gpu::kBlockVoxels + i]));
    }
    return volume;
}

}  // namespace patina
