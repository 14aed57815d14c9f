#pragma once

#include <cstdint>
#include <initializer_list>
#include <mutex>
#include <span>
#include <vector>

#include "sensor/kinect2/transport.h"

namespace patina::sensor::kinect2 {

enum class Opcode : uint32_t {
    kFirmware = 0x02,
    kStartInfrared = 0x09,
    kStopInfrared = 0x0A,
    kHardware = 0x14,
    kStatus = 0x16,
    kPage = 0x22,
    kColorStream = 0x2B,
    kColorSetting = 0x3E,
    kMode = 0x4B,
};

/// How long a reply may be. Most are shorter than the most; a reply below the least is an error.
struct ReplyBytes {
    uint32_t least = 0;
    uint32_t most = 0;
};

/// The device's commands, strictly one at a time: request, payload of the reply where it has one, completion. May be
/// called from several threads.
class Commands {
  public:
    /// The transport must outlive this.
    explicit Commands(Transport& transport) : transport_(transport) {}

    /// Sends a command; returns the payload. Throws Error when the completion comes early, belongs to another command
    /// or has a status other than 0, or when the payload is too short; else as Transport.
    std::vector<uint8_t> execute(Opcode opcode, std::initializer_list<uint32_t> parameters = {}, ReplyBytes reply = {});

    /// A colour camera setting (0x3E): writes `argument`, returns the reply's data. Throws as execute(), and when the
    /// reply's own status is not 0.
    uint32_t color_setting(uint32_t setting, uint32_t argument);

  private:
    std::vector<uint8_t> transact(Opcode opcode, uint32_t sequence, std::initializer_list<uint32_t> parameters,
                                  ReplyBytes reply);
    void expect_completion(Opcode opcode, uint32_t sequence);

    Transport& transport_;
    std::mutex mutex_;
    uint32_t sequence_ = 0;
};

}  // namespace patina::sensor::kinect2
