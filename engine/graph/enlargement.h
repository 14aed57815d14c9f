#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "engine/graph/frame_graph.h"
#include "engine/vulkan/resources.h"

namespace patina::graph {

/// What a buffer holds once it was enlarged.
struct EnlargedContent {
    bool kept = true;                ///< what it held before, from byte `offset` on; else nothing of it
    uint64_t offset = 0;             ///< where that begins in the larger buffer
    std::optional<uint32_t> fill{};  ///< of what is not kept; empty: undefined
};

/// Replaces buffers that outlive frames by larger ones with the same content: all of them or, where memory runs out or
/// the frame that copies them is not submitted, none. Between frames, in a graph of its own: announce the buffers,
/// allocate(), commit(), submit the frame, accept(). What was committed and not accepted is undone with its end.
class Enlargement {
  public:
    explicit Enlargement(vulkan::Device& device) : device_(&device) {}
    Enlargement(Enlargement&&) = default;
    Enlargement& operator=(Enlargement&&) = delete;
    ~Enlargement();

    /// Announces that `buffer`, which must outlive this, becomes one of `bytes`.
    void add(vulkan::BufferRef& buffer, uint64_t bytes, const EnlargedContent& content = {});
    /// The same for an array, whose elements keep their places.
    void add(vulkan::ChunkedBuffer& array, uint64_t elements);
    /// Announces that `value`, which must outlive this, becomes `next` once the larger buffers are in place.
    template <class Value>
    void set(Value& value, Value next) {
        exchanges_.push_back([&value, next]() mutable { std::swap(value, next); });
    }

    /// Bytes of device memory that allocate() takes. The old buffers' are given back when the frame has finished.
    uint64_t bytes() const;

    /// Throws Error when memory runs out; then nothing has changed.
    void allocate();

    /// Copies the content within `frame`, and puts the larger buffers in the places of the old ones. What the frame
    /// imports from then on is the larger ones.
    void commit(FrameGraph& frame);

    /// Marks the larger buffers as needed after the frame, in the versions that they have by now.
    void keep(FrameGraph& frame) const;

    /// The frame was submitted: the old buffers are not needed any more.
    void accept();

  private:
    struct Single {
        vulkan::BufferRef* buffer;
        uint64_t bytes;
        EnlargedContent content;
        vulkan::BufferRef larger{};
    };
    struct Array {
        vulkan::ChunkedBuffer* array;
        uint64_t elements;
        vulkan::ChunkedBuffer larger{};
    };

    void exchange();

    vulkan::Device* device_;
    std::vector<Single> singles_;
    std::vector<Array> arrays_;
    std::vector<std::function<void()>> exchanges_;  ///< each undoes itself when called again
    std::vector<vulkan::BufferRef> committed_;      ///< what commit() wrote to
    bool exchanged_ = false;
};

}  // namespace patina::graph
