#include "sensor/readers/tum.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/input_file.h"
#include "sensor/associate.h"
#include "sensor/files/picture_file.h"
#include "sensor/files/text_file.h"
#include "sensor/pose.h"
#include "sensor/readers/folder_source.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

constexpr double kAssociationLimit_s = 0.02;  // as in the benchmark's associate.py
constexpr double kUnitsPerMetre = 5000;
constexpr Extent2D kExtent{640, 480};

/// Pictures and when they were taken.
struct PictureList {
    std::vector<double> timestamps_s;
    std::vector<fs::path> files;
};

PictureList read_list(const fs::path& file) {
    PictureList list;
    for (const TextLine& line : read_lines(file)) {
        line.expect_columns("timestamp path");
        list.timestamps_s.push_back(line.finite(0));
        list.files.push_back(file.parent_path() / line.word(1));
    }
    if (list.files.empty()) throw Error(file.string(), " has no frames: it lists 0 pictures");
    return list;
}

/// The benchmark's intrinsics of the recording that a folder's name, or its parent's, tells.
Intrinsics intrinsics_by_name(const fs::path& folder) {
    const fs::path absolute = fs::absolute(folder).lexically_normal();
    const std::string name = folder_name(absolute);
    const std::string parent = folder_name(absolute.parent_path());
    const auto is = [&](const char* number) {
        const auto within = [&](const std::string& text) {
            return text.find(std::string("freiburg") + number) != std::string::npos ||
                   text.find(std::string("fr") + number) != std::string::npos;
        };
        return within(name) || within(parent);
    };
    if (is("1")) return {kExtent, 517.3, 516.5, 318.6, 255.3, {}};
    if (is("2")) return {kExtent, 520.9, 521.0, 325.1, 249.7, {}};
    if (is("3")) return {kExtent, 535.4, 539.2, 320.1, 247.6, {}};
    return {kExtent, 525, 525, 319.5, 239.5, {}};
}

/// One over the median time between frames, which gaps in the recording do not move.
double frame_rate(const std::vector<double>& timestamps_s, double fallback) {
    std::vector<double> steps;
    for (size_t i = 1; i < timestamps_s.size(); ++i) steps.push_back(timestamps_s[i] - timestamps_s[i - 1]);
    if (steps.empty()) return fallback;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle > 0 ? 1 / *middle : fallback;
}

class TumSource : public FolderSource {
  public:
    explicit TumSource(const fs::path& folder)
        : depth_(read_list(folder / "depth.txt")), color_(read_list(folder / "rgb.txt")) {
        info_.name = folder_name(folder);
        info_.format = "tum";
        info_.frames = static_cast<uint32_t>(depth_.files.size());
        info_.fps = frame_rate(depth_.timestamps_s, info_.fps);
        info_.color = info_.depth = intrinsics_by_name(folder);
        info_.metres_per_unit = 1 / kUnitsPerMetre;
        expect_known_size(color_.files);
        expect_known_size(depth_.files);
        color_of_frame_ = associate(depth_.timestamps_s, color_.timestamps_s, kAssociationLimit_s);
        if (const fs::path trajectory = folder / "groundtruth.txt"; path_exists(trajectory)) {
            poses_ = FramePoses(trajectory, depth_.timestamps_s, kAssociationLimit_s);
        }
        info_.has_poses = !poses_.empty();
    }

  private:
    static void expect_known_size(const std::vector<fs::path>& pictures) {
        const Extent2D extent = first_readable_extent(pictures);
        if (extent != kExtent) {
            throw Error(pictures.front().parent_path().string(), " holds pictures of ", extent,
                        " pixels, but TUM RGB-D's intrinsics are known for ", kExtent, " only");
        }
    }

    Frame decode(uint32_t index) const override {
        Frame frame;
        frame.index = index;
        frame.timestamp_s = depth_.timestamps_s[index];
        if (!color_of_frame_[index]) {
            throw Error(depth_.files[index].string(), " has no colour picture within ", kAssociationLimit_s,
                        " s of its timestamp ", fixed(frame.timestamp_s, 6));
        }
        set_pose(frame, poses_.of_frame(index));
        frame.color = read_color(color_.files[*color_of_frame_[index]], info_.color.extent);
        frame.depth = read_depth(depth_.files[index], info_.depth.extent);
        return frame;
    }

    PictureList depth_;
    PictureList color_;
    std::vector<std::optional<size_t>> color_of_frame_;
    FramePoses poses_;
};

}  // namespace

bool is_tum_sequence(const fs::path& folder) {
    return path_exists(folder / "rgb.txt") && path_exists(folder / "depth.txt");
}

std::unique_ptr<Source> open_tum(const fs::path& folder) { return std::make_unique<TumSource>(folder); }

}  // namespace patina::sensor
