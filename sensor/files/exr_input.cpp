#include "sensor/files/exr_input.h"

#include <cstring>

#include "sensor/files/picture_container.h"

namespace patina::sensor {

ExrBytes::ExrBytes(const std::string& file, std::span<const uint8_t> bytes)
    : Imf::IStream(file.c_str()), bytes_(bytes) {}

bool ExrBytes::read(char* to, int count) {
    if (count < 0 || position_ > bytes_.size() || static_cast<uint64_t>(count) > bytes_.size() - position_) {
        throw Error(fileName(), " is truncated: it has ", bytes_.size(), " bytes, but ", count, " from byte ",
                    position_, " on are needed");
    }
    std::memcpy(to, bytes_.data() + position_, static_cast<size_t>(count));
    position_ += static_cast<uint64_t>(count);
    return position_ < bytes_.size();
}

ExrInput::ExrInput(const std::string& file, std::span<const uint8_t> bytes)
    : extent_(check_exr(bytes, file)), bytes_(file, bytes), file_(bytes_) {}

}  // namespace patina::sensor
