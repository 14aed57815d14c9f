#include "tests/simulated_kinect2/simulated_device.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "tests/simulated_kinect2/flat_jpeg.h"
#include "tests/simulated_kinect2/pages.h"
#include "tests/simulated_kinect2/words.h"

namespace patina::sensor::kinect2::testing {
namespace {

constexpr uint32_t kRequestMagic = 0x06022009, kCompletionMagic = 0x0A6FE000;
constexpr uint32_t kNotReady = 0x400, kReady = 0x2601, kReadyAndStarted = 0x2603;

std::vector<uint8_t> completion(uint32_t sequence, uint32_t status) {
    std::vector<uint8_t> bytes;
    for (const uint32_t word : {kCompletionMagic, sequence, status, 0u}) put(bytes, word);
    return bytes;
}

SentPicture grey_picture(uint32_t frame) {
    SentPicture picture;
    picture.jpeg = flat_jpeg(1920, 1080, static_cast<uint8_t>(frame));
    picture.filler = 4 * (frame % 5);
    return picture;
}

}  // namespace

SimulatedDeviceOptions::SimulatedDeviceOptions() : pages(pages_of(simulated_calibration())), pictures(grey_picture) {}

SimulatedDevice::SimulatedDevice(SimulatedDeviceOptions options) : options_(std::move(options)) {}

bool SimulatedDevice::pass_call() {
    if (gone_) return false;
    ++calls_;
    if (calls_left_ != UINT64_MAX && calls_left_-- == 0) gone_ = true;
    return !gone_;
}

void SimulatedDevice::complain(const std::string& what) {
    if (complaint_.empty()) complaint_ = what;
}

Answer SimulatedDevice::control(uint8_t type, uint8_t request, uint16_t value, uint16_t index) {
    const std::lock_guard lock(mutex_);
    if (!pass_call()) return Answer::kGone;
    const bool feature = request == 0x03;
    if (type == 0x00 && request == 0x31 && value == 40 && index == 0) return Answer::kDone;
    if (type == 0x00 && feature && (value == 48 || value == 49) && index == 0) {
        return options_.commands.high_speed ? Answer::kStalled : Answer::kDone;
    }
    if (type == 0x01 && feature && value == 0 && (index == 0x0300 || index == 0)) {
        suspended_ = index != 0;
        return Answer::kDone;
    }
    complain("unknown control request " + std::to_string(request) + ", value " + std::to_string(value));
    return Answer::kStalled;
}

Answer SimulatedDevice::send(std::span<const uint8_t> bytes) {
    const std::lock_guard lock(mutex_);
    if (!pass_call()) return Answer::kGone;
    if (!replies_.empty()) complain("a command came before the last one's replies were read");
    replies_.clear();
    const uint32_t sequence = word_at(bytes, 4), most = word_at(bytes, 8), opcode = word_at(bytes, 12);
    if (bytes.size() < 20 || bytes.size() % 4 != 0 || word_at(bytes, 0) != kRequestMagic) complain("no request");
    if (opcode == 0x3E) {
        if (sequence != 0) complain("a colour setting's sequence is not 0");
    } else if (next_sequence_ && sequence < *next_sequence_) {  // settings in between count, too
        complain("sequence " + std::to_string(sequence) + " after " + std::to_string(*next_sequence_ - 1));
    } else {
        next_sequence_ = sequence + 1;
    }
    if (suspended_ && opcode != 0x4B) complain("command " + std::to_string(opcode) + " to a suspended device");
    opcodes_.push_back(opcode);
    answer(opcode, sequence, most, bytes.subspan(std::min<size_t>(20, bytes.size())));
    return Answer::kDone;
}

bool SimulatedDevice::strikes(std::optional<uint32_t> fault, uint32_t opcode) {
    return fault == opcode && options_.commands.times-- > 0;
}

void SimulatedDevice::answer(uint32_t opcode, uint32_t sequence, uint32_t most, std::span<const uint8_t> parameters) {
    const CommandFaults& faults = options_.commands;
    if (strikes(faults.silent, opcode)) return;
    std::optional<std::vector<uint8_t>> reply = payload(opcode, parameters);
    if (!reply || strikes(faults.failing, opcode)) return replies_.push_back(completion(sequence, 1));
    if (strikes(faults.early_completion, opcode)) return replies_.push_back(completion(sequence, 0));
    if (strikes(faults.short_payload, opcode)) reply->resize(3);
    if (reply->size() > most) reply->resize(most);
    if (most > 0) replies_.push_back(*std::move(reply));
    replies_.push_back(completion(strikes(faults.wrong_sequence, opcode) ? sequence + 7 : sequence, 0));
    update_streams();
}

/// Empty for an opcode or a parameter that is unknown.
std::optional<std::vector<uint8_t>> SimulatedDevice::payload(uint32_t opcode, std::span<const uint8_t> parameters) {
    switch (opcode) {
        case 0x02: return options_.pages.firmware;
        case 0x09: infrared_started_ = true; return std::vector<uint8_t>();
        case 0x0A: infrared_started_ = false; return std::vector<uint8_t>();
        case 0x14: return std::vector<uint8_t>(92, 0x31);
        case 0x16: return word_at(parameters, 0) == 0x00090000 ? std::optional(status()) : std::nullopt;
        case 0x22: return page(word_at(parameters, 0));
        case 0x2B: color_started_ = word_at(parameters, 0) == 1; return std::vector<uint8_t>();
        case 0x3E: return apply_setting(parameters);
        case 0x4B: return parameters.size() == 16 ? std::optional(std::vector<uint8_t>()) : std::nullopt;
        default: return std::nullopt;
    }
}

std::optional<std::vector<uint8_t>> SimulatedDevice::page(uint32_t number) const {
    switch (number) {
        case 1: return options_.pages.serial;
        case 2: return options_.pages.p0_tables;
        case 3: return options_.pages.depth_parameters;
        case 4: return options_.pages.color_parameters;
        default: return std::nullopt;
    }
}

std::vector<uint8_t> SimulatedDevice::status() {
    std::vector<uint8_t> bytes;
    const bool ready = options_.commands.not_ready_polls-- <= 0;
    put(bytes, !ready ? kNotReady : infrared_started_ ? kReadyAndStarted : kReady);
    return bytes;
}

std::vector<uint8_t> SimulatedDevice::apply_setting(std::span<const uint8_t> parameters) {
    const uint32_t id = word_at(parameters, 8), argument = word_at(parameters, 12);
    const bool reads = id == 14 || id == 15 || id == 16;
    if (word_at(parameters, 0) != 1 || word_at(parameters, 4) != 0) complain("not one setting");
    if (!reads) color_settings_[id] = argument;
    const uint32_t written = id - 3;  // 11 to 13 write what 14 to 16 read
    const uint32_t gain = color_settings_.contains(written) ? color_settings_[written] : std::bit_cast<uint32_t>(1.5f);
    std::vector<uint8_t> reply;
    for (const uint32_t word : {1u, 0u, 0u, reads ? gain : 0u}) put(reply, word);
    return reply;
}

Answer SimulatedDevice::receive(std::span<uint8_t> bytes, size_t& length) {
    const std::lock_guard lock(mutex_);
    if (!pass_call()) return Answer::kGone;
    if (replies_.empty()) return Answer::kTimedOut;
    const std::vector<uint8_t> reply = std::move(replies_.front());
    replies_.pop_front();
    length = std::min(bytes.size(), reply.size());
    if (length < reply.size()) complain("a reply does not fit");
    std::copy_n(reply.begin(), length, bytes.begin());
    return Answer::kDone;
}

Answer SimulatedDevice::set_alternate_setting(uint8_t interface, uint8_t setting) {
    const std::lock_guard lock(mutex_);
    if (!pass_call()) return Answer::kGone;
    if (interface != 1 || setting > 1) {
        complain("unknown alternate setting");
        return Answer::kStalled;
    }
    if (setting == 1 && options_.commands.no_bandwidth) return Answer::kNoBandwidth;
    if (setting == 1 && !infrared_started_) complain("alternate setting 1 before the infrared stream was initialised");
    alternate_setting_ = setting;
    update_streams();
    return Answer::kDone;
}

Answer SimulatedDevice::reset() {
    const std::lock_guard lock(mutex_);
    if (!pass_call()) return Answer::kGone;
    suspended_ = infrared_started_ = color_started_ = false;
    alternate_setting_ = 0;
    next_sequence_.reset();
    replies_.clear();
    update_streams();
    return Answer::kDone;
}

void SimulatedDevice::update_streams() {
    if (!infrared_started_ || alternate_setting_ != 1) {
        infrared_.reset();
    } else if (!infrared_) {
        infrared_.emplace(options_.infrared_images,
                          StreamStart{options_.first_infrared_sequence, options_.first_timestamp}, options_.infrared);
    }
    if (!color_started_) {
        color_.reset();
    } else if (!color_) {
        color_.emplace(options_.pictures, StreamStart{options_.first_color_sequence, options_.first_timestamp},
                       options_.color_delay, infrared_ ? infrared_->intervals() : 0, options_.color);
    }
}

void SimulatedDevice::pass_interval(const std::function<void(const SentPacket&)>& infrared,
                                    const std::function<bool(std::span<const uint8_t>)>& color) {
    const std::lock_guard lock(mutex_);
    if (!pass_call()) return;
    if (infrared_) {
        const SentPacket packet = infrared_->next_interval();
        if (!packet.omitted) infrared(packet);
    }
    if (color_) {
        color_->pass_interval();
        if (!color_->front().empty() && color(color_->front())) color_->pop();
    }
}

void SimulatedDevice::set_faults(InfraredFaults infrared, ColorFaults color) {
    const std::lock_guard lock(mutex_);
    options_.infrared = std::move(infrared);
    options_.color = std::move(color);
}

bool SimulatedDevice::streaming_infrared() const {
    const std::lock_guard lock(mutex_);
    return infrared_.has_value();
}

bool SimulatedDevice::streaming_color() const {
    const std::lock_guard lock(mutex_);
    return color_.has_value();
}

std::optional<uint32_t> SimulatedDevice::color_setting(uint32_t id) const {
    const std::lock_guard lock(mutex_);
    const auto found = color_settings_.find(id);
    return found == color_settings_.end() ? std::nullopt : std::optional(found->second);
}

std::string SimulatedDevice::complaint() const {
    const std::lock_guard lock(mutex_);
    return complaint_;
}

std::vector<uint32_t> SimulatedDevice::opcodes() const {
    const std::lock_guard lock(mutex_);
    return opcodes_;
}

}  // namespace patina::sensor::kinect2::testing
