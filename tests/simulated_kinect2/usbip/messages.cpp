#include "tests/simulated_kinect2/usbip/messages.h"

#include <algorithm>
#include <cerrno>
#include <span>

namespace patina::sensor::kinect2::testing::usbip {
namespace {

constexpr uint16_t kVersion = 0x0111, kRequestBit = 0x8000;
constexpr uint32_t kSubmit = 1, kUnlink = 2, kSubmitReply = 3, kUnlinkReply = 4;
constexpr size_t kHeaderBytes = 48, kBusNameBytes = 32, kPathBytes = 256, kDeviceBytes = 312;
/// More than one transfer of the driver has; what asks for more is not understood.
constexpr uint32_t kMostBytes = 16u << 20, kMostPackets = 1024;

void put(std::vector<uint8_t>& bytes, uint32_t word) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<uint8_t>(word >> shift));
}

void put_short(std::vector<uint8_t>& bytes, uint16_t word) {
    bytes.push_back(static_cast<uint8_t>(word >> 8));
    bytes.push_back(static_cast<uint8_t>(word));
}

void put_text(std::vector<uint8_t>& bytes, std::string text, size_t size) {
    text.resize(size);
    bytes.insert(bytes.end(), text.begin(), text.end());
}

uint32_t word_at(std::span<const uint8_t> bytes, size_t index) {
    uint32_t word = 0;
    for (size_t i = 0; i < 4; ++i) word = word << 8 | bytes[4 * index + i];
    return word;
}

void put_device(std::vector<uint8_t>& bytes) {
    put_text(bytes, "/simulated/kinect2", kPathBytes);
    put_text(bytes, kBusName, kBusNameBytes);
    for (const uint32_t word : {kBus, kAddress, kSuperSpeed}) put(bytes, word);
    for (const uint16_t word : {uint16_t{0x045E}, uint16_t{0x02C4}, uint16_t{0x0100}}) put_short(bytes, word);
    // Class, subclass, protocol, configuration, configurations, interfaces.
    bytes.insert(bytes.end(), {0, 0, 0, 1, 1, 2});
}

void put_header(std::vector<uint8_t>& bytes, uint32_t kind, uint32_t sequence) {
    for (const uint32_t word : {kind, sequence, 0u, 0u, 0u}) put(bytes, word);
}

}  // namespace

std::optional<Request> read_request(const Socket& host) {
    std::array<uint8_t, 8> head{};
    if (!host.read(head) || word_at(head, 0) >> 16 != kVersion) return std::nullopt;
    Request request;
    request.operation = static_cast<Operation>(word_at(head, 0) & ~uint32_t{kRequestBit} & 0xFFFF);
    if (request.operation == Operation::kList) return request;
    std::array<uint8_t, kBusNameBytes> name{};
    if (request.operation != Operation::kImport || !host.read(name)) return std::nullopt;
    request.bus_name.assign(name.begin(), std::ranges::find(name, uint8_t{0}));
    return request;
}

bool write_request(const Socket& server, const Request& request) {
    std::vector<uint8_t> bytes;
    put_short(bytes, kVersion);
    put_short(bytes, static_cast<uint16_t>(kRequestBit | static_cast<uint16_t>(request.operation)));
    put(bytes, 0);
    if (request.operation == Operation::kImport) put_text(bytes, request.bus_name, kBusNameBytes);
    return server.write(bytes);
}

bool write_answer(const Socket& host, Operation operation, bool found) {
    std::vector<uint8_t> bytes;
    put_short(bytes, kVersion);
    put_short(bytes, static_cast<uint16_t>(operation));
    put(bytes, found || operation == Operation::kList ? 0 : 1);
    if (operation == Operation::kList) put(bytes, found ? 1 : 0);
    if (found) put_device(bytes);
    if (found && operation == Operation::kList) {  // class, subclass and protocol of both interfaces, padded
        bytes.insert(bytes.end(), {0xFF, 0, 0, 0, 0xFF, 0, 0, 0});
    }
    return host.write(bytes);
}

bool read_import_answer(const Socket& server) {
    std::array<uint8_t, 8> head{};
    std::array<uint8_t, kDeviceBytes> device{};
    return server.read(head) && word_at(head, 1) == 0 && server.read(device);
}

std::optional<Command> read_command(const Socket& host) {
    std::array<uint8_t, kHeaderBytes> header{};
    if (!host.read(header)) return std::nullopt;
    Command command;
    command.unlink = word_at(header, 0) == kUnlink;
    command.sequence = word_at(header, 1);
    command.unlinked = command.unlink ? word_at(header, 5) : 0;
    if (command.unlink) return command;
    if (word_at(header, 0) != kSubmit || word_at(header, 2) != kDevice) return std::nullopt;
    command.in = word_at(header, 3) == 1;
    command.endpoint = word_at(header, 4);
    command.length = word_at(header, 6);
    const uint32_t packets = word_at(header, 8) == UINT32_MAX ? 0 : word_at(header, 8);
    std::copy_n(header.end() - 8, 8, command.setup.begin());
    if (command.length > kMostBytes || packets > kMostPackets) return std::nullopt;
    if (!command.in) command.data.resize(command.length);
    std::vector<uint8_t> list(16 * size_t{packets});
    if (!host.read(command.data) || !host.read(list)) return std::nullopt;
    for (size_t i = 0; i < packets; ++i) {
        command.packets.push_back({word_at(list, 4 * i), word_at(list, 4 * i + 1)});
    }
    return command;
}

bool write_reply(const Socket& host, const Command& command, const Reply& reply) {
    const auto failed = std::ranges::count_if(command.packets, [](const auto& packet) { return packet.status != 0; });
    const auto packets = static_cast<uint32_t>(command.packets.size());
    std::vector<uint8_t> bytes;
    bytes.reserve(kHeaderBytes + reply.data.size() + 16 * packets);
    put_header(bytes, kSubmitReply, command.sequence);
    put(bytes, static_cast<uint32_t>(reply.status));
    put(bytes, command.in ? static_cast<uint32_t>(reply.data.size()) : reply.actual_length);
    for (const uint32_t word : {0u, packets, static_cast<uint32_t>(failed), 0u, 0u}) put(bytes, word);
    bytes.insert(bytes.end(), reply.data.begin(), reply.data.end());
    for (const IsochronousPacket& packet : command.packets) {
        put(bytes, packet.offset);
        put(bytes, packet.length);
        put(bytes, packet.actual_length);
        put(bytes, static_cast<uint32_t>(packet.status));
    }
    return host.write(bytes);
}

bool write_unlink_reply(const Socket& host, const Command& command, bool found) {
    std::vector<uint8_t> bytes;
    put_header(bytes, kUnlinkReply, command.sequence);
    put(bytes, found ? static_cast<uint32_t>(-ECONNRESET) : 0);
    bytes.resize(kHeaderBytes);
    return host.write(bytes);
}

}  // namespace patina::sensor::kinect2::testing::usbip
