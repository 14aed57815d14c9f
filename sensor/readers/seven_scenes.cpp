#include "sensor/readers/seven_scenes.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/core/input_file.h"
#include "sensor/files/picture_file.h"
#include "sensor/files/text_file.h"
#include "sensor/pose.h"
#include "sensor/readers/folder_source.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

constexpr uint16_t kInvalidDepth = 65535;
constexpr Extent2D kKinectExtent{640, 480};
const Intrinsics kKinectDepth{kKinectExtent, 585, 585, 320, 240, {}};
const Intrinsics kKinectColor{kKinectExtent, 528, 528, 322.7, 236.8, {}};
constexpr glm::dvec3 kKinectColorFromDepth_m{-0.0305, 0.0036, 0};

constexpr std::string_view kPrefix = "frame-";
constexpr const char* kIntrinsicsFiles[] = {"camera-intrinsics.txt", "intrinsics.K.txt"};

/// The NNNNNN of frame-NNNNNN.SUFFIX; empty for every other name.
std::string frame_number(const std::string& name, std::string_view suffix) {
    if (!name.starts_with(kPrefix) || !name.ends_with(suffix) || name.size() <= kPrefix.size() + suffix.size())
        return {};
    const std::string digits = name.substr(kPrefix.size(), name.size() - kPrefix.size() - suffix.size());
    const bool is_number = digits.size() < 10 && digits.find_first_not_of("0123456789") == std::string::npos;
    return is_number ? digits : std::string{};
}

/// Every frame of which there is any file, so that a missing picture is noticed; ordered by number.
std::vector<std::string> frame_numbers(const fs::path& folder) {
    std::set<std::string> found;
    for (const fs::path& entry : entries_of(folder)) {
        for (const char* suffix : {".color.png", ".color.jpg", ".depth.png", ".pose.txt"}) {
            const std::string digits = frame_number(entry.filename().string(), suffix);
            if (!digits.empty()) found.insert(digits);
        }
    }
    std::vector<std::string> numbers(found.begin(), found.end());
    std::sort(numbers.begin(), numbers.end(),
              [](const std::string& a, const std::string& b) { return std::stoul(a) < std::stoul(b); });
    return numbers;
}

/// Reads fx 0 cx, 0 fy cy, 0 0 1.
Intrinsics read_camera_matrix(const fs::path& file, Extent2D extent) {
    const std::vector<double> values = read_numbers(file, 9);
    for (size_t i = 0; i < values.size(); ++i) {
        const bool focal_length = i == 0 || i == 4;
        if (std::isfinite(values[i]) && (values[i] > 0 || !focal_length)) continue;
        throw Error(file.string(), ": number ", i + 1, " is ", values[i], ", must be ",
                    focal_length ? "positive" : "finite");
    }
    return {extent, values[0], values[4], values[2], values[5], {}};
}

class SevenScenesSource : public FolderSource {
  public:
    explicit SevenScenesSource(const fs::path& folder) : folder_(folder), numbers_(frame_numbers(folder)) {
        if (numbers_.empty()) throw Error(folder.string(), " has no frames: no file frame-NNNNNN.depth.png");
        info_.name = folder_name(folder);
        info_.format = "7-scenes";
        info_.frames = static_cast<uint32_t>(numbers_.size());
        info_.has_poses = std::any_of(numbers_.begin(), numbers_.end(), [&](const std::string& number) {
            return path_exists(file(number, ".pose.txt"));
        });
        set_cameras();
    }

  private:
    fs::path file(const std::string& number, const char* suffix) const {
        return folder_ / ("frame-" + number + suffix);
    }

    fs::path color_file(const std::string& number) const {
        const fs::path jpeg = file(number, ".color.jpg");
        return path_exists(jpeg) ? jpeg : file(number, ".color.png");
    }

    void set_cameras() {
        std::vector<fs::path> colors, depths;
        for (const std::string& number : numbers_) {
            colors.push_back(color_file(number));
            depths.push_back(file(number, ".depth.png"));
        }
        const Extent2D color_extent = first_readable_extent(colors);
        const Extent2D depth_extent = first_readable_extent(depths);
        const bool of_kinect = color_extent == kKinectExtent && depth_extent == kKinectExtent;
        const fs::path matrix = intrinsics_file();
        if (matrix.empty() && !of_kinect) {
            throw Error(folder_.string(), " has no camera-intrinsics.txt, and its pictures, ", color_extent, " and ",
                        depth_extent, " pixels, are not 7-Scenes' ", kKinectExtent);
        }
        const Intrinsics depth = matrix.empty() ? kKinectDepth : read_camera_matrix(matrix, depth_extent);
        if (depth == kKinectDepth && of_kinect) {
            set_kinect();
        } else {
            set_registered(depth, color_extent);
        }
    }

    fs::path intrinsics_file() const {
        for (const char* name : kIntrinsicsFiles) {
            if (path_exists(folder_ / name)) return folder_ / name;
        }
        return {};
    }

    void set_kinect() {
        info_.depth = kKinectDepth;
        info_.color = kKinectColor;
        info_.color_from_depth[3] = glm::dvec4(kKinectColorFromDepth_m, 1.0);
    }

    void set_registered(const Intrinsics& camera, Extent2D color_extent) {
        if (color_extent != camera.extent) {
            throw Error(folder_.string(), " has colour of ", color_extent, " pixels and depth of ", camera.extent,
                        ", but one intrinsics file for both");
        }
        info_.depth = info_.color = camera;
    }

    Frame decode(uint32_t index) const override {
        const std::string& number = numbers_[index];
        Frame frame;
        frame.index = index;
        frame.timestamp_s = static_cast<double>(std::stoul(number)) / info_.fps;
        if (info_.has_poses) {
            const fs::path pose_file = file(number, ".pose.txt");
            set_pose(frame, checked_pose(read_matrix(pose_file), pose_file.string()));
        }
        frame.color = read_color(color_file(number), info_.color.extent);
        frame.depth = read_depth(file(number, ".depth.png"), info_.depth.extent, kInvalidDepth);
        return frame;
    }

    fs::path folder_;
    std::vector<std::string> numbers_;
};

}  // namespace

bool is_seven_scenes_sequence(const fs::path& folder) {
    const std::vector<fs::path> entries = entries_of(folder);
    return std::any_of(entries.begin(), entries.end(), [](const fs::path& entry) {
        return !frame_number(entry.filename().string(), ".depth.png").empty();
    });
}

std::unique_ptr<Source> open_seven_scenes(const fs::path& folder) {
    return std::make_unique<SevenScenesSource>(folder);
}

}  // namespace patina::sensor
