#include "cameras/open_sequence.h"

#include <utility>

#include "sensor/open.h"
#include "sensor/prefetch.h"

namespace patina::cameras {

sensor::MakePayloadDecoder payload_decoders(Kinect2PayloadDecoder::GiveDevice give_device,
                                            Kinect2PayloadDecoder::OnInfrared on_infrared) {
    return [give_device = std::move(give_device), on_infrared = std::move(on_infrared)](
               const sensor::RecordedSequence& sequence,
               const std::string& where) -> std::unique_ptr<sensor::PayloadDecoder> {
        if (!is_kinect2(sequence)) return nullptr;
        return std::make_unique<Kinect2PayloadDecoder>(give_device, sequence, where, on_infrared);
    };
}

sensor::MakePayloadDecoder payload_decoders(vulkan::Device& device) {
    return payload_decoders([&device]() -> vulkan::Device& { return device; });
}

std::unique_ptr<Source> open_sequence(vulkan::Device& device, const std::filesystem::path& path,
                                      const std::string& format) {
    return sensor::open_sequence(path, format, payload_decoders(device));
}

std::unique_ptr<Source> open_sequence_ahead(vulkan::Device& device, const std::filesystem::path& path,
                                            const std::string& format) {
    bool raw = false;
    const auto decoders = payload_decoders(device);
    auto source = sensor::open_sequence(path, format, [&](const auto& sequence, const std::string& where) {
        auto decoder = decoders(sequence, where);
        raw = decoder != nullptr;
        return decoder;
    });
    if (raw) return source;
    return std::make_unique<sensor::PrefetchSource>(std::move(source));
}

}  // namespace patina::cameras
