#include "sensor/readers/native.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/input_file.h"
#include "sensor/files/json_file.h"
#include "sensor/files/picture_file.h"
#include "sensor/files/text_file.h"
#include "sensor/pose.h"
#include "sensor/readers/folder_source.h"
#include "sensor/sequence_json.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

constexpr double kMostPoseLag_s = 0.02;  // TUM's own limit for its trajectories

/// Calls use(index, line) for each line of a file of 'index ...' lines; throws Error on an index out of range or given
/// twice.
template <class Use>
void read_indexed_lines(const fs::path& file, std::string_view columns, uint32_t frames, Use use) {
    std::vector<bool> seen(frames);
    for (const TextLine& line : read_lines(file)) {
        line.expect_columns(columns);
        const uint32_t index = line.index(0);
        if (index >= frames) throw Error(line.where(), ": index is ", index, ", but there are ", frames, " frames");
        if (seen[index]) throw Error(line.where(), ": index ", index, " appears a second time");
        seen[index] = true;
        use(index, line);
    }
}

std::vector<double> read_timestamps(const fs::path& file, const SequenceInfo& info) {
    const uint32_t frames = *info.frames;
    std::vector<double> timestamps_s(frames, std::nan(""));
    if (!path_exists(file)) {
        for (uint32_t i = 0; i < frames; ++i) timestamps_s[i] = i / info.fps;
        return timestamps_s;
    }
    read_indexed_lines(file, "index timestamp", frames,
                       [&](uint32_t index, const TextLine& line) { timestamps_s[index] = line.finite(1); });
    const auto missing = std::find_if(timestamps_s.begin(), timestamps_s.end(), [](double t) { return std::isnan(t); });
    if (missing != timestamps_s.end()) {
        throw Error(file.string(), " has no line for frame ", missing - timestamps_s.begin(), " of ", frames);
    }
    return timestamps_s;
}

double positive(const TextLine& line, size_t column) {
    const double value = line.finite(column);
    if (!(value > 0)) throw Error(line.where(), ": column ", column + 1, " is ", value, ", must be positive");
    return value;
}

std::vector<Exposure> read_exposures(const fs::path& file, uint32_t frames, Exposure common) {
    std::vector<Exposure> exposures(frames, common);
    if (!path_exists(file)) return exposures;
    read_indexed_lines(file, "index exposure_s gain", frames, [&](uint32_t index, const TextLine& line) {
        exposures[index] = {positive(line, 1), positive(line, 2)};
    });
    return exposures;
}

/// The file of a frame's picture, whichever of the format's file types it is.
fs::path picture_path(const fs::path& folder, uint32_t index) {
    const std::string stem = picture_stem(index);
    for (const char* extension : {".png", ".jpg", ".jpeg", ".exr"}) {
        if (fs::path path = folder / (stem + extension); path_exists(path)) return path;
    }
    throw Error((folder / stem).string(), " is missing, as .png, .jpg, .jpeg and .exr");
}

/// Throws Error when the pictures at both ends of the sequence agree on another size than sequence.json's: then that
/// file, not one picture, is wrong. A single picture of another size is left to its frame.
void expect_pictures_of_size(const fs::path& folder, Extent2D expected, uint32_t frames, const char* key) {
    if (!is_folder(folder)) throw Error(folder.string(), " is missing, but sequence.json promises ", frames, " frames");
    std::array<Extent2D, 2> found{expected, expected};
    std::array<uint32_t, 2> ends{0, frames - 1};
    for (size_t i = 0; i < ends.size(); ++i) {
        try {
            found[i] = picture_extent(picture_path(folder, ends[i]));
        } catch (const std::exception&) {
            return;  // a damaged frame says so itself when its turn comes
        }
    }
    if (found[0] == found[1] && found[0] != expected) {
        throw Error((folder.parent_path() / "sequence.json").string(), ": ", key, " is ", expected, " pixels, but ",
                    picture_path(folder, 0).string(), " is ", found[0]);
    }
}

/// Throws Error when more than half of the frames that sequence.json promises have neither a colour nor a depth
/// picture: the number is wrong then, and nothing is allotted for it. Fewer missing frames are skipped one by one.
void expect_frames(const fs::path& folder, uint32_t frames) {
    const size_t colors = entries_of(folder / "color").size(), depths = entries_of(folder / "depth").size();
    if (frames / 2 <= std::max(colors, depths)) return;
    throw Error((folder / "sequence.json").string(), ": frames is ", frames, ", but color/ holds ", colors,
                " files and depth/ ", depths);
}

class NativeSource : public FolderSource {
  public:
    explicit NativeSource(const fs::path& folder) : folder_(folder) {
        const JsonValue root = JsonValue::read(folder / "sequence.json");
        const SequenceDescription sequence = parse_sequence(root, folder_name(folder));
        info_ = sequence.info;
        info_.frames = root.at("frames").positive_integer();
        expect_pictures_of_size(folder / "color", info_.color.extent, *info_.frames, "color");
        expect_pictures_of_size(folder / "depth", info_.depth.extent, *info_.frames, "depth");
        expect_frames(folder, *info_.frames);
        timestamps_s_ = read_timestamps(folder / "timestamps.txt", info_);
        exposures_ = read_exposures(folder / "exposures.txt", *info_.frames, sequence.exposure);
        info_.exposure_known = info_.exposure_known || path_exists(folder / "exposures.txt");
        if (const fs::path trajectory = folder / "trajectory.txt"; path_exists(trajectory)) {
            poses_ = FramePoses(trajectory, timestamps_s_, std::min(kMostPoseLag_s, 0.5 / info_.fps));
        }
        info_.has_poses = !poses_.empty();
    }

  private:
    Frame decode(uint32_t index) const override {
        Frame frame;
        frame.index = index;
        frame.timestamp_s = timestamps_s_[index];
        frame.exposure = exposures_[index];
        set_pose(frame, poses_.of_frame(index));
        frame.color = read_color(picture_path(folder_ / "color", index), info_.color.extent);
        frame.depth = read_depth(picture_path(folder_ / "depth", index), info_.depth.extent);
        return frame;
    }

    fs::path folder_;
    std::vector<double> timestamps_s_;
    std::vector<Exposure> exposures_;
    FramePoses poses_;
};

}  // namespace

bool is_native_sequence(const fs::path& folder) { return path_exists(folder / "sequence.json"); }

std::unique_ptr<Source> open_native(const fs::path& folder) { return std::make_unique<NativeSource>(folder); }

}  // namespace patina::sensor
