#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/vulkan/format.h"
#include "patina/image.h"

namespace patina::vulkan {

/// Where a buffer lives.
enum class MemoryKind : uint8_t {
    kDevice,    ///< fastest for the device; the host cannot see it
    kUpload,    ///< written by the host, mapped for its whole life
    kReadback,  ///< read by the host, mapped for its whole life
};

struct BufferDesc {
    std::string name;
    uint64_t bytes = 0;
    MemoryKind memory = MemoryKind::kDevice;
};

/// A two-dimensional image with one level and one layer, always in the general layout once used.
struct ImageDesc {
    std::string name;
    Extent2D extent;
    Format format = Format::kR32f;
    bool composed = false;  ///< pictures and a user interface are drawn into it (compose.h); kRgba8 alone
};

struct MemoryRequirement {
    uint64_t bytes = 0;
    uint64_t alignment = 1;
};

struct BufferObject;
struct ImageObject;
struct MemoryObject;

/// A Vulkan buffer, freed when its last reference goes; a frame in flight holds one.
class Buffer {
  public:
    explicit Buffer(std::unique_ptr<BufferObject> object);
    ~Buffer();
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;

    const BufferDesc& desc() const { return desc_; }
    uint64_t bytes() const { return desc_.bytes; }
    uint64_t serial() const { return serial_; }    ///< never used again by another resource of the device
    std::byte* mapped() const { return mapped_; }  ///< null for device memory
    BufferObject& object() const { return *object_; }

  private:
    std::unique_ptr<BufferObject> object_;
    BufferDesc desc_;
    uint64_t serial_;
    std::byte* mapped_;
};

/// A Vulkan image with its view; ownership as for Buffer.
class DeviceImage {
  public:
    explicit DeviceImage(std::unique_ptr<ImageObject> object);
    ~DeviceImage();
    DeviceImage(const DeviceImage&) = delete;
    DeviceImage& operator=(const DeviceImage&) = delete;

    const ImageDesc& desc() const { return desc_; }
    uint64_t serial() const { return serial_; }
    ImageObject& object() const { return *object_; }

  private:
    std::unique_ptr<ImageObject> object_;
    ImageDesc desc_;
    uint64_t serial_;
};

using BufferRef = std::shared_ptr<Buffer>;
using ImageRef = std::shared_ptr<DeviceImage>;
using MemoryRef = std::shared_ptr<MemoryObject>;

class Device;

/// An array too large for one storage-buffer range, split into buffers of `chunk_elements` elements each (the last one
/// shorter); element i lies in chunk i / chunk_elements. Shaders bind all chunks as one array of buffers.
class ChunkedBuffer {
  public:
    ChunkedBuffer() = default;
    /// Throws Error when a chunk exceeds the device's storage-buffer range, `max_chunks` do not suffice, or memory runs
    /// out.
    ChunkedBuffer(Device& device, const std::string& name, uint64_t elements, uint32_t bytes_per_element,
                  uint64_t chunk_elements, uint32_t max_chunks);

    /// The same array with room for `elements`, no fewer than before: full chunks are shared with this one, a last one
    /// that was not full is replaced by a larger one of undefined content. Throws Error as the constructor does.
    ChunkedBuffer with_room_for(uint64_t elements) const;

    const std::vector<BufferRef>& chunks() const { return chunks_; }
    const std::string& name() const { return name_; }
    uint64_t elements() const { return elements_; }
    uint32_t bytes_per_element() const { return bytes_per_element_; }
    uint64_t bytes() const;
    /// Bytes of the chunks that with_room_for(elements) makes.
    uint64_t bytes_to_make(uint64_t elements) const;

  private:
    uint64_t chunk_bytes(uint64_t chunk, uint64_t elements) const;
    void add_chunks(uint64_t elements);

    Device* device_ = nullptr;
    std::string name_;
    uint64_t elements_ = 0;
    uint32_t bytes_per_element_ = 0;
    uint64_t chunk_elements_ = 1;
    uint32_t max_chunks_ = 0;
    std::vector<BufferRef> chunks_;
};

}  // namespace patina::vulkan
