#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "cameras/kinect2_recorded.h"

namespace patina::cameras {

/// Makes the decoders of all that cameras send. `give_device` and `on_infrared` as in Kinect2PayloadDecoder.
sensor::MakePayloadDecoder payload_decoders(Kinect2PayloadDecoder::GiveDevice give_device,
                                            Kinect2PayloadDecoder::OnInfrared on_infrared = {});

/// With a device that is there already.
sensor::MakePayloadDecoder payload_decoders(vulkan::Device& device);

/// Opens a recorded sequence as sensor::open_sequence does, raw recordings of cameras included. `device` outlives it,
/// and is used by next() alone.
std::unique_ptr<Source> open_sequence(vulkan::Device& device, const std::filesystem::path& path,
                                      const std::string& format = "");

/// The same, read and decoded ahead on a thread of its own. Raw recordings are not: `device` decodes them, and its
/// queue is for the thread that calls next().
std::unique_ptr<Source> open_sequence_ahead(vulkan::Device& device, const std::filesystem::path& path,
                                            const std::string& format = "");

}  // namespace patina::cameras
