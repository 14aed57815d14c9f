#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/simulated_kinect2/usbip/socket.h"

// The messages of USB/IP, version 1.1.1, as "USB/IP protocol" in the documentation of the Linux kernel has them.
// Numbers are big-endian on the wire, but for those in a control request's setup packet.

namespace patina::sensor::kinect2::testing::usbip {

constexpr uint16_t kPort = 3240;  ///< the registered one
constexpr uint32_t kBus = 1, kAddress = 2, kDevice = kBus << 16 | kAddress;
constexpr uint32_t kSuperSpeed = 5;
constexpr const char* kBusName = "1-1";

enum class Operation : uint16_t { kList = 5, kImport = 3 };

/// What a host asks for before a device is attached.
struct Request {
    Operation operation = Operation::kList;
    std::string bus_name;  ///< which device is imported
};

/// Empty: the host is gone, or what it says is not understood.
std::optional<Request> read_request(const Socket& host);
bool write_request(const Socket& server, const Request& request);

/// The simulated device on bus 1, or that there is none.
bool write_answer(const Socket& host, Operation operation, bool found);
/// What the server answers to an import: whether the device is there.
bool read_import_answer(const Socket& server);

/// A packet of an isochronous transfer.
struct IsochronousPacket {
    uint32_t offset = 0, length = 0, actual_length = 0;
    int32_t status = 0;  ///< negative: an errno
};

/// A transfer that the host submits, or takes back.
struct Command {
    bool unlink = false;
    uint32_t sequence = 0;
    uint32_t unlinked = 0;  ///< the sequence of the transfer that is taken back
    bool in = false;        ///< to the host
    uint32_t endpoint = 0;
    uint32_t length = 0;
    std::array<uint8_t, 8> setup{};
    std::vector<uint8_t> data;  ///< to the device
    std::vector<IsochronousPacket> packets;
};

std::optional<Command> read_command(const Socket& host);

/// How a transfer ended.
struct Reply {
    int32_t status = 0;              ///< negative: an errno
    uint32_t actual_length = 0;      ///< of an OUT transfer; of an IN transfer it is that of `data`
    std::vector<uint8_t> data = {};  ///< to the host; isochronous packets without gaps
};

bool write_reply(const Socket& host, const Command& command, const Reply& reply);
/// That a transfer was taken back; `found` is false where it had ended before.
bool write_unlink_reply(const Socket& host, const Command& command, bool found);

}  // namespace patina::sensor::kinect2::testing::usbip
