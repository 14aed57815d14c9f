#include "sensor/readers/folder_source.h"

#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "sensor/files/picture_file.h"

namespace patina::sensor {

std::optional<Reading> FolderSource::next() {
    if (next_ == info_.frames) return std::nullopt;
    const uint32_t index = next_++;
    // One frame's files cost that frame, whatever a library makes of them.
    try {
        return decode(index);
    } catch (const Error& error) {
        return Skipped{index, error.what()};
    } catch (const std::exception& error) {
        return Skipped{index, text("frame ", index, " cannot be decoded: ", reason_of(error))};
    }
}

void set_pose(Frame& frame, const std::optional<CheckedPose>& pose) {
    if (!pose) return;
    frame.world_from_camera = pose->transform;
    frame.pose_defect = pose->defect;
}

std::string folder_name(const std::filesystem::path& folder) {
    const std::filesystem::path absolute = std::filesystem::absolute(folder).lexically_normal();
    const std::string name =
        (absolute.has_filename() ? absolute.filename() : absolute.parent_path().filename()).string();
    return nlohmann::json::parse(nlohmann::json(name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

Extent2D first_readable_extent(const std::vector<std::filesystem::path>& pictures) {
    std::string reason;
    for (const std::filesystem::path& picture : pictures) {
        try {
            return picture_extent(picture);
        } catch (const std::exception& error) {
            if (reason.empty()) reason = reason_of(error);
        }
    }
    throw Error("none of ", pictures.size(), " pictures can be read, the first because ", reason);
}

}  // namespace patina::sensor
