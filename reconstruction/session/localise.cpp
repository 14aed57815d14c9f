#include "reconstruction/session/localise.h"

#include <algorithm>
#include <limits>
#include <string>

#include "engine/core/error.h"
#include "reconstruction/session/rgbd_frame.h"

namespace patina {
namespace {

/// Geometry with keyframes, tracked. Colours are fused where the main sequence's poses are tracked, as they are there.
ReconstructionSettings settings_of(const LocaliseOptions& options, bool given) {
    ReconstructionSettings settings = options.settings;
    settings.gains.reset();
    settings.reflectance.reset();
    settings.segmentation.reset();
    settings.specular.reset();
    settings.network.reset();
    settings.fusion.color = settings.fusion.color && !given;
    if (!settings.tracking) settings.tracking.emplace();
    if (!settings.keyframes) settings.keyframes.emplace();
    // The sequence's frames come without colours, so that places that only these tell apart are of no use.
    settings.keyframes->tests = KeyframeTests::kDepth;
    return settings;
}

/// A depth picture that waits to be located.
struct Waiting {
    uint32_t index = 0;
    DepthImage depth;
};

class Localiser {
  public:
    Localiser(vulkan::Device& device, const LocaliseOptions& options, bool given)
        : options_(options), given_(given), pipeline_(device, settings_of(options, given)) {}

    void fuse_main(Source& main) {
        const SequenceInfo& info = main.info();
        const uint32_t frames = options_.frames > 0 ? std::min(options_.frames, *info.frames) : *info.frames;
        for (uint32_t done = 0; done < frames; ++done) {
            const auto reading = main.next();
            if (!reading) break;
            if (const auto* frame = std::get_if<Frame>(&*reading)) fuse_main(info, *frame);
            report("room", done + 1, frames);
        }
        if (pipeline_.frames() == 0) throw Error("no frame of the main sequence could be used");
    }

    FoundPoses locate(Source& sequence) {
        info_ = sequence.info();
        // Not a number: no pixel has a known colour.
        no_color_ = Image<glm::vec3>(info_.color.extent);
        for (glm::vec3& pixel : no_color_.pixels()) pixel = glm::vec3(std::numeric_limits<float>::quiet_NaN());
        std::vector<Waiting> waiting;
        while (auto reading = sequence.next()) {
            if (auto* frame = std::get_if<Frame>(&*reading)) waiting.push_back({frame->index, std::move(frame->depth)});
        }
        poses_.assign(*info_.frames, std::nullopt);
        total_ = static_cast<uint32_t>(waiting.size());
        // Frames before the first one that is found are reached from it backwards.
        for (int direction = 0; direction < 2 && !waiting.empty(); ++direction) {
            locate(waiting);
            std::reverse(waiting.begin(), waiting.end());
        }
        return poses_;
    }

  private:
    void fuse_main(const SequenceInfo& info, const Frame& frame) {
        if (given_ && !frame.world_from_camera) return;
        const RgbdFrame rgbd = to_rgbd(info, frame);
        if (given_) {
            pipeline_.add_posed(rgbd);
        } else {
            pipeline_.add(rgbd);
        }
    }

    /// Takes out of `waiting` what is found, in its order.
    void locate(std::vector<Waiting>& waiting) {
        std::erase_if(waiting, [&](const Waiting& each) { return locate(each); });
    }

    bool locate(const Waiting& waiting) {
        Frame frame;
        frame.index = waiting.index;
        frame.timestamp_s = clock_s_ += 1 / info_.fps;
        RgbdFrame rgbd = to_rgbd(info_, frame);
        std::visit([&](const auto& image) { rgbd.depth.pixels = std::span(image.pixels()); }, waiting.depth);
        rgbd.color.pixels = std::span<const glm::vec3>(no_color_.pixels());
        rgbd.held_out = true;  // there are no colours to fuse
        const bool found = pipeline_.add(rgbd);
        if (found) {
            poses_.at(waiting.index) = pipeline_.tracking_report()->world_from_depth;
            ++found_;
        }
        report("lighting", found_, total_);
        return found;
    }

    void report(const char* what, uint32_t done, uint32_t total) const {
        if (options_.on_frame) options_.on_frame(what, done, total);
    }

    const LocaliseOptions& options_;
    bool given_;
    Pipeline pipeline_;
    SequenceInfo info_;
    Image<glm::vec3> no_color_;
    FoundPoses poses_;
    double clock_s_ = 0;
    uint32_t found_ = 0, total_ = 0;
};

}  // namespace

FoundPoses localise(vulkan::Device& device, Source& main, Source& sequence, const LocaliseOptions& options) {
    Localiser localiser(device, options, main.info().has_poses && !options.track);
    localiser.fuse_main(main);
    FoundPoses poses = localiser.locate(sequence);
    if (std::none_of(poses.begin(), poses.end(), [](const auto& pose) { return pose.has_value(); })) {
        throw Error("none of the ", poses.size(), " frames of '", sequence.info().name,
                    "' was found in the main sequence's room: it has no poses, and must begin or end with a view that "
                    "the main sequence has too, or have a trajectory.txt");
    }
    return poses;
}

}  // namespace patina
