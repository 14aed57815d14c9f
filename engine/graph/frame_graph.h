#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

#include "engine/graph/plan/description.h"
#include "engine/vulkan/resources.h"
#include "engine/vulkan/shader.h"

namespace patina::vulkan {
class Device;
}

namespace patina::graph {

/// A version of a resource within one frame. A write returns the next version; using an older one afterwards is an
/// error.
struct ResourceId {
    uint32_t resource = UINT32_MAX;
    uint32_t version = 0;

    bool valid() const { return resource != UINT32_MAX; }
    bool operator==(const ResourceId&) const = default;
};

/// A buffer version, or one of an array of chunks (vulkan::ChunkedBuffer) that shaders bind as one.
struct BufferId : ResourceId {};
/// An image version.
struct ImageId : ResourceId {};

/// Extent and format of an image that a pass creates.
struct ImageShape {
    Extent2D extent;
    vulkan::Format format = vulkan::Format::kR32f;

    bool operator==(const ImageShape&) const = default;
};

/// Bytes that arrive from the device when the frame that copied them has finished.
class Readback {
  public:
    bool ready() const { return state_ && state_->ready; }

    /// The bytes as elements of T. Throws Error before the frame has finished.
    template <class T>
    std::vector<T> as() const {
        static_assert(std::is_trivially_copyable_v<T>);
        require_ready();
        std::vector<T> values(state_->bytes.size() / sizeof(T));
        std::copy_n(state_->bytes.data(), values.size() * sizeof(T), reinterpret_cast<std::byte*>(values.data()));
        return values;
    }

    /// The bytes themselves, for as long as this or a copy of it is there. Throws Error before the frame has finished.
    std::span<const std::byte> bytes() const {
        require_ready();
        return state_->bytes;
    }

    /// An image read back: as many T per pixel as fit its format.
    template <class T>
    Image<T> image() const {
        return Image<T>(state_->extent, as<T>());
    }

    /// Hands over the bytes; called by the runner.
    void deliver(const std::byte* source, uint64_t bytes);

  private:
    friend class FrameGraph;
    struct State {
        bool ready = false;
        std::string name;
        Extent2D extent;
        std::vector<std::byte> bytes;
    };
    void require_ready() const;
    std::shared_ptr<State> state_;
};

/// The device's time for one frame, known once the frame has finished; unknown for ever without timestamps.
class FrameTime {
  public:
    std::optional<double> ms() const { return *ms_; }

    /// Sets it; called by the runner.
    void deliver(double ms) { *ms_ = ms; }

  private:
    std::shared_ptr<std::optional<double>> ms_ = std::make_shared<std::optional<double>>();
};

/// Memory that the host fills now and the device reads in this frame.
struct Staging {
    vulkan::BufferRef buffer;
    uint64_t offset = 0;
    std::byte* mapped = nullptr;
};

namespace work {

struct Bound {
    const vulkan::ShaderBinding* binding = nullptr;
    uint32_t resource = 0;
};

/// A compute dispatch: fixed group counts, or arguments in a buffer.
struct Dispatch {
    const vulkan::Shader* shader = nullptr;
    std::vector<std::pair<uint32_t, uint32_t>> constants;  ///< id, value; sorted by id
    std::vector<Bound> bound;
    std::array<std::byte, 128> push{};
    std::array<uint32_t, 3> groups{};
    std::optional<uint32_t> indirect;  ///< resource that holds the arguments
    uint64_t indirect_offset = 0;
};

struct Fill {
    uint32_t resource = 0;
    uint32_t value = 0;
    uint64_t bytes = 0;  ///< of each chunk; UINT64_MAX fills it whole
};

/// Host memory to a resource.
struct Upload {
    uint32_t resource = 0;
    uint64_t offset = 0;
    uint64_t bytes = 0;
    Staging staging;
};

/// A resource to host memory.
struct Download {
    uint32_t resource = 0;
    uint64_t offset = 0;
    uint64_t bytes = 0;
    Readback target;
    std::optional<glm::uvec2> pixel{};  ///< of an image: this one alone
};

/// Between two buffers.
struct Copy {
    uint32_t source = 0;
    uint32_t destination = 0;
    uint64_t source_offset = 0;
    uint64_t destination_offset = 0;
    uint64_t bytes = 0;
};

}  // namespace work

using Work = std::variant<work::Dispatch, work::Fill, work::Upload, work::Download, work::Copy>;

class FrameGraph;

/// Declares one compute pass. Every binding of the shader is named once; the pass joins the frame with its dispatch.
/// All mistakes (unknown name, wrong kind, access wider than the shader's, missing binding, wrong push size) throw
/// Error naming the pass and the binding.
class PassBuilder {
  public:
    PassBuilder(FrameGraph& frame, std::string name, const vulkan::Shader& shader);

    /// Binds what the shader only reads: a storage or uniform buffer, a texel buffer, a storage or sampled image.
    PassBuilder& read(const char* binding, BufferId id);
    PassBuilder& read(const char* binding, ImageId id);

    /// Binds what the shader replaces as a whole; earlier content is not needed. Returns the written version.
    BufferId write(const char* binding, BufferId id);
    ImageId write(const char* binding, ImageId id);

    /// Binds what the shader reads and writes, or writes in part. Returns the written version.
    BufferId modify(const char* binding, BufferId id);
    ImageId modify(const char* binding, ImageId id);

    /// Creates a transient resource that the shader writes as a whole.
    ImageId create(const char* binding, ImageShape shape);
    BufferId create(const char* binding, uint64_t bytes);

    /// Sets a specialization constant by name.
    PassBuilder& specialise(const char* constant, uint32_t value);

    /// Sets the push constants: the shader's one struct.
    template <class Params>
    PassBuilder& push(const Params& params) {
        static_assert(std::is_trivially_copyable_v<Params>);
        set_push(&params, sizeof(Params));
        return *this;
    }

    /// As many groups as cover `extent` pixels, or `items` in x. More than 65535 groups in x are an error.
    void dispatch_covering(Extent2D extent);
    void dispatch_covering(uint32_t items);
    void dispatch(uint32_t groups_x, uint32_t groups_y = 1, uint32_t groups_z = 1);
    /// Group counts from three u32 at `offset` bytes of a buffer.
    void dispatch_indirect(BufferId arguments, uint64_t offset = 0);

  private:
    enum class Intent : uint8_t { kRead, kWrite, kModify };
    uint32_t bind(const char* binding, ResourceId id, ResourceKind kind, Intent intent);
    Use use_of(const vulkan::ShaderBinding& binding, Intent intent) const;
    void check_shape(const vulkan::ShaderBinding& binding, uint32_t resource) const;
    void set_push(const void* data, size_t bytes);
    void finish();
    template <class... Parts>
    [[noreturn]] void fail(const Parts&... parts) const;

    FrameGraph& frame_;
    Pass pass_;
    work::Dispatch dispatch_;
    bool pushed_ = false;
};

/// One frame under construction: resources and passes in order. Made by Runner::begin(), consumed by Runner::submit().
class FrameGraph {
  public:
    /// Brings a resource that outlives the frame into it; the same resource twice yields the same id.
    BufferId import(const vulkan::BufferRef& buffer);
    BufferId import(const vulkan::ChunkedBuffer& buffer);
    ImageId import(const vulkan::ImageRef& image);

    /// Declares a transient resource for a later write(); most are made by PassBuilder::create.
    BufferId create_buffer(const std::string& name, uint64_t bytes);
    ImageId create_image(const std::string& name, ImageShape shape);

    PassBuilder compute(const std::string& name, const vulkan::Shader& shader) { return {*this, name, shader}; }

    /// Copies host data into a new transient resource, or over a part of a buffer. Uploads, copies and read-backs throw
    /// Error where they leave a buffer, or where it has several chunks.
    template <class T>
    BufferId upload(const std::string& name, std::span<const T> values) {
        const BufferId id = create_buffer(name, values.size_bytes());
        return upload_bytes(id, 0, std::as_bytes(values), true);
    }
    ImageId upload(const std::string& name, ImageShape shape, std::span<const std::byte> pixels);
    /// Copies host data over the whole of an image.
    ImageId upload(ImageId id, std::span<const std::byte> pixels);
    BufferId upload_bytes(BufferId id, uint64_t offset, std::span<const std::byte> bytes, bool whole);

    /// Sets every u32 of a buffer (all its chunks), or of its first `bytes`; the rest is then undefined.
    BufferId fill(BufferId id, uint32_t value, uint64_t bytes = UINT64_MAX);

    /// Copies a part of a buffer over a part of another.
    BufferId copy(BufferId source, uint64_t source_offset, BufferId destination, uint64_t destination_offset,
                  uint64_t bytes);

    /// Brings a buffer's part, or an image, to the host; kept by itself.
    Readback read_back(BufferId id, uint64_t offset, uint64_t bytes);
    Readback read_back(BufferId id);
    Readback read_back(ImageId id);
    /// One pixel of an image. Throws Error where it lies outside.
    Readback read_back_pixel(ImageId id, glm::uvec2 pixel);

    /// How long the device takes for this frame.
    FrameTime time() const { return time_; }

    /// Marks a version as needed after the frame. Passes that feed nothing kept are culled.
    void keep(ResourceId id);

    ImageShape shape(ImageId id) const;
    uint64_t bytes(BufferId id) const;
    /// The images' common extent. Throws Error naming the first that differs.
    Extent2D common_extent(std::initializer_list<ImageId> ids) const;

    /// What stands behind a resource.
    struct Physical {
        std::vector<vulkan::BufferRef> buffers;  ///< imported buffers: their chunks
        vulkan::ImageRef image;                  ///< imported images
        ImageShape shape;
        uint64_t bytes = 0;
    };

    const Description& description() const { return description_; }
    const Physical& physical(uint32_t resource) const { return physical_[resource]; }
    /// What each pass of the description does, in the same order.
    const std::vector<Work>& work() const { return work_; }

  private:
    friend class PassBuilder;
    friend class Runner;

    FrameGraph(vulkan::Device& device, class Runner& runner) : device_(&device), runner_(&runner) {}
    uint32_t add_resource(Resource resource, Physical physical);
    /// Throws Error where a transfer would leave the buffer, or the buffer has several chunks.
    void check_range(const char* transfer, BufferId id, uint64_t offset, uint64_t bytes) const;
    uint32_t current_version(uint32_t resource) const { return versions_[resource]; }
    void add_transfer(const std::string& name, uint32_t resource, Use use, Work work);
    MemoryNeed need_of(uint64_t bytes);
    MemoryNeed need_of(ImageShape shape);

    vulkan::Device* device_;
    class Runner* runner_;
    Description description_;
    std::vector<Physical> physical_;
    std::vector<uint32_t> versions_;
    std::vector<Work> work_;  ///< one per pass of the description
    FrameTime time_;
    std::unordered_map<uint64_t, uint32_t> imported_;
};

}  // namespace patina::graph
