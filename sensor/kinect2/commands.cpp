#include "sensor/kinect2/commands.h"

#include <array>
#include <ios>

#include "sensor/kinect2/little_endian.h"

namespace patina::sensor::kinect2 {
namespace {

constexpr uint32_t kRequestMagic = 0x06022009;
constexpr uint32_t kCompletionMagic = 0x0A6FE000;
constexpr size_t kCompletionBytes = 16;

struct Hex {
    uint32_t value;
    friend std::ostream& operator<<(std::ostream& out, Hex hex) {
        return out << "0x" << std::hex << hex.value << std::dec;
    }
};

Hex hex(Opcode opcode) { return Hex{static_cast<uint32_t>(opcode)}; }

bool is_completion(std::span<const uint8_t> bytes) {
    return bytes.size() == kCompletionBytes && read_at<uint32_t>(bytes, 0) == kCompletionMagic;
}

std::vector<uint8_t> request(Opcode opcode, uint32_t sequence, std::initializer_list<uint32_t> parameters,
                             uint32_t most_reply) {
    std::vector<uint8_t> bytes;
    for (const uint32_t word : {kRequestMagic, sequence, most_reply, static_cast<uint32_t>(opcode), uint32_t{0}}) {
        append(bytes, word);
    }
    for (const uint32_t parameter : parameters) append(bytes, parameter);
    return bytes;
}

}  // namespace

std::vector<uint8_t> Commands::execute(Opcode opcode, std::initializer_list<uint32_t> parameters, ReplyBytes reply) {
    const std::lock_guard lock(mutex_);
    return transact(opcode, sequence_++, parameters, reply);
}

uint32_t Commands::color_setting(uint32_t setting, uint32_t argument) {
    const std::lock_guard lock(mutex_);
    // One setting a command; their request's own sequence is always 0.
    const std::vector<uint8_t> reply = transact(Opcode::kColorSetting, 0, {1, 0, setting, argument}, {16, 16});
    const auto list_status = read_at<uint32_t>(reply, 4), status = read_at<uint32_t>(reply, 8);
    if (list_status != 0 || status != 0) {
        throw Error(transport_.name(), ": colour setting ", setting, " was refused with status ", list_status, ", ",
                    status);
    }
    return read_at<uint32_t>(reply, 12);
}

std::vector<uint8_t> Commands::transact(Opcode opcode, uint32_t sequence, std::initializer_list<uint32_t> parameters,
                                        ReplyBytes reply) {
    transport_.send(request(opcode, sequence, parameters, reply.most));
    std::vector<uint8_t> payload(reply.most);
    if (reply.most > 0) {
        payload.resize(transport_.receive(payload));
        if (is_completion(payload)) {
            throw Error(transport_.name(), ": command ", hex(opcode), " ended before its reply, with status ",
                        read_at<uint32_t>(payload, 8));
        }
    }
    expect_completion(opcode, sequence);
    if (payload.size() < reply.least) {
        throw Error(transport_.name(), ": the reply to command ", hex(opcode), " has ", payload.size(),
                    " bytes, must have ", reply.least);
    }
    return payload;
}

void Commands::expect_completion(Opcode opcode, uint32_t sequence) {
    std::array<uint8_t, kCompletionBytes> bytes{};
    const size_t length = transport_.receive(bytes);
    if (!is_completion(std::span(bytes).first(length))) {
        throw Error(transport_.name(), ": command ", hex(opcode), " was not completed: ", length,
                    " other bytes came instead");
    }
    const auto answered = read_at<uint32_t>(bytes, 4), status = read_at<uint32_t>(bytes, 8);
    if (answered != sequence) {
        throw Error(transport_.name(), ": command ", hex(opcode), " has number ", sequence,
                    ", the completion is that of number ", answered);
    }
    if (status != 0) throw Error(transport_.name(), ": command ", hex(opcode), " failed with status ", Hex{status});
}

}  // namespace patina::sensor::kinect2
