#pragma once

#include <deque>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/graph/runner.h"
#include "engine/graph/state_visitor.h"
#include "engine/vulkan/device.h"
#include "reconstruction/store/map_file.h"

namespace patina {

/// The device's part of both: graphs of its own, each with some MiB of transfers.
class StateTransfer : public graph::StateVisitor {
  protected:
    StateTransfer(vulkan::Device& device, MapFile& map) : runner_(device), map_(map) {}

    graph::FrameGraph& frame();
    /// Counts transfers of the frame; whether it is time to flush.
    bool is_full_with(uint64_t bytes);
    /// Submits the frame, where there is one, and waits; whether there was one.
    bool submit();

    graph::Runner runner_;
    MapFile& map_;

  private:
    std::optional<graph::FrameGraph> frame_;
    uint64_t frame_bytes_ = 0;
};

/// Keeps state in a map: every part is an array of its name. Within a Transaction; what is visited is in the file after
/// finish(). Throws Error where the file cannot be written, two parts have one name, or the device was lost.
class StateWriter : public StateTransfer {
  public:
    /// All work on the device must have finished. Both must outlive this.
    StateWriter(vulkan::Device& device, MapFile& map) : StateTransfer(device, map) {}

    bool brings_back() const override { return false; }
    void buffer(vulkan::BufferRef& buffer) override;
    void array(vulkan::ChunkedBuffer& array) override;
    void image(vulkan::ImageRef& image) override;
    void bytes(const std::string& name, std::vector<std::byte>& bytes) override;

    void finish() { flush(); }

  private:
    /// A piece whose parts are on their way from the device.
    struct Pending {
        std::string array;
        uint64_t piece = 0;
        std::vector<graph::Readback> parts;
    };
    void begin(const std::string& name, uint64_t bytes);
    void chunks(const std::string& name, const std::vector<vulkan::BufferRef>& chunks);
    void flush();

    std::set<std::string> names_;
    std::deque<Pending> pending_;
};

/// Brings state back from a map, the other way round. Throws Error where the map lacks a part or it does not fit,
/// memory runs out, or the device was lost; what was visited by then is to be thrown away.
class StateReader : public StateTransfer {
  public:
    StateReader(vulkan::Device& device, MapFile& map) : StateTransfer(device, map) {}

    bool brings_back() const override { return true; }
    void buffer(vulkan::BufferRef& buffer) override;
    void array(vulkan::ChunkedBuffer& array) override;
    void image(vulkan::ImageRef& image) override;
    void bytes(const std::string& name, std::vector<std::byte>& bytes) override;

    /// Waits until the device has all.
    void finish() { flush(); }

  private:
    void chunks(const std::string& name, const std::vector<vulkan::BufferRef>& chunks);
    std::vector<std::byte> all_of(const std::string& name);
    void flush();

    std::vector<vulkan::BufferRef> written_;  ///< in this frame
};

}  // namespace patina
