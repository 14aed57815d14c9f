#include "tests/simulated_kinect2/bus_options.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

namespace patina::sensor::kinect2::testing {
namespace {

namespace fs = std::filesystem;

constexpr size_t kFrameBytes = 2984960;

std::string variable(const char* name) {
    const char* value = std::getenv((std::string("PATINA_KINECT2_") + name).c_str());
    return value ? value : "";
}

double number(const char* name, double otherwise) {
    const std::string value = variable(name);
    return value.empty() ? otherwise : std::strtod(value.c_str(), nullptr);
}

std::vector<uint8_t> bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Which of `count` recorded frames a sent one is: the last one stays, or they come forth and back without end.
uint64_t place_of(uint32_t frame, uint64_t count, bool swings) {
    if (!swings || count < 2) return std::min<uint64_t>(frame, count - 1);
    const uint64_t place = frame % (2 * (count - 1));
    return std::min(place, 2 * (count - 1) - place);
}

InfraredSignal::Images frames_of(const fs::path& file, bool swings) {
    const uint64_t count = std::max<uint64_t>(1, fs::file_size(file) / kFrameBytes);
    return [file, count, swings](uint32_t frame) {
        auto bytes = std::make_shared<std::vector<uint8_t>>(kFrameBytes);
        std::ifstream in(file, std::ios::binary);
        in.seekg(static_cast<std::streamoff>(place_of(frame, count, swings) * kFrameBytes));
        in.read(reinterpret_cast<char*>(bytes->data()), static_cast<std::streamsize>(bytes->size()));
        return std::shared_ptr<const std::vector<uint8_t>>(std::move(bytes));
    };
}

/// Two frames in turn, which cost nothing to make.
InfraredSignal::Images two_frames() {
    return [first = patterned_frame(0), second = patterned_frame(1)](uint32_t frame) {
        return frame % 2 == 0 ? first : second;
    };
}

ColorSignal::Pictures pictures_of(const fs::path& folder, bool swings) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    std::ranges::sort(files);
    return [files, swings](uint32_t frame) {
        SentPicture picture;
        if (!files.empty()) picture.jpeg = bytes_of(files[place_of(frame, files.size(), swings)]);
        return picture;
    };
}

}  // namespace

BusOptions BusOptions::from_environment() {
    BusOptions options;
    if (!variable("DEVICE").empty()) options.device = variable("DEVICE");
    options.high_speed = variable("SPEED") == "high";
    options.denied = variable("ACCESS") == "denied";
    options.busy = variable("ACCESS") == "busy";
    options.moves = variable("RESET") == "moves";
    options.cancel_hangs = variable("CANCEL") == "hangs";
    options.no_bandwidth = variable("BANDWIDTH") == "none";
    options.frames_per_second = number("RATE", 30);
    options.usbfs_bytes = static_cast<uint64_t>(number("USBFS_MB", 16)) << 20;
    options.unplug_after_intervals = static_cast<uint64_t>(number("UNPLUG_AFTER", 0) * 800 / 3);
    options.unplug_file = variable("UNPLUG_FILE");
    options.transient_failures = static_cast<uint64_t>(number("SUBMIT_FAILS", 0));
    options.lose_every = static_cast<uint32_t>(number("LOSE_EVERY", 0));
    options.swings = variable("SWING") == "1";
    options.infrared_file = variable("INFRARED");
    options.color_folder = variable("COLOR");
    return options;
}

SimulatedDeviceOptions BusOptions::device_options() const {
    SimulatedDeviceOptions simulated;
    simulated.commands.high_speed = high_speed;
    simulated.commands.no_bandwidth = no_bandwidth;
    simulated.infrared_images = infrared_file.empty() ? two_frames() : frames_of(infrared_file, swings);
    if (!color_folder.empty()) simulated.pictures = pictures_of(color_folder, swings);
    if (lose_every > 0) {
        simulated.infrared.packet = [every = lose_every](const PacketPlace& at, SentPacket& packet) {
            packet.complete = at.frame % every != every - 1 || at.sub_image != 4 || at.packet != 4;
        };
    }
    return simulated;
}

}  // namespace patina::sensor::kinect2::testing
