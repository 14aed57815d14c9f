#include "engine/graph/frame_graph.h"

#include <algorithm>
#include <cstring>

#include "engine/graph/runner.h"
#include "engine/vulkan/device.h"

namespace patina::graph {

void Readback::require_ready() const {
    if (!ready())
        throw Error("the read-back of '", state_ ? state_->name : "nothing",
                    "' was used before its frame had finished");
}

void Readback::deliver(const std::byte* source, uint64_t bytes) {
    state_->bytes.assign(source, source + bytes);
    state_->ready = true;
}

uint32_t FrameGraph::add_resource(Resource resource, Physical physical) {
    description_.resources.push_back(std::move(resource));
    physical_.push_back(std::move(physical));
    versions_.push_back(0);
    return static_cast<uint32_t>(physical_.size() - 1);
}

MemoryNeed FrameGraph::need_of(uint64_t bytes) {
    const auto need = device_->requirement(vulkan::BufferDesc{"", bytes});
    return {need.bytes, need.alignment};
}

MemoryNeed FrameGraph::need_of(ImageShape shape) {
    const auto need = device_->requirement(vulkan::ImageDesc{"", shape.extent, shape.format});
    return {need.bytes, need.alignment};
}

BufferId FrameGraph::import(const vulkan::BufferRef& buffer) {
    const auto [found, fresh] = imported_.try_emplace(buffer->serial(), 0);
    if (fresh) {
        found->second =
            add_resource({buffer->desc().name, ResourceKind::kBuffer, true, {}}, {{buffer}, {}, {}, buffer->bytes()});
    }
    return {{found->second, versions_[found->second]}};
}

BufferId FrameGraph::import(const vulkan::ChunkedBuffer& buffer) {
    const vulkan::BufferRef& first = buffer.chunks().front();
    const auto [found, fresh] = imported_.try_emplace(first->serial(), 0);
    if (fresh) {
        found->second = add_resource({first->desc().name, ResourceKind::kBuffer, true, {}},
                                     {buffer.chunks(), {}, {}, buffer.bytes()});
    }
    return {{found->second, versions_[found->second]}};
}

ImageId FrameGraph::import(const vulkan::ImageRef& image) {
    const auto [found, fresh] = imported_.try_emplace(image->serial(), 0);
    if (fresh) {
        const vulkan::ImageDesc& desc = image->desc();
        found->second =
            add_resource({desc.name, ResourceKind::kImage, true, {}}, {{}, image, {desc.extent, desc.format}, 0});
    }
    return {{found->second, versions_[found->second]}};
}

BufferId FrameGraph::create_buffer(const std::string& name, uint64_t bytes) {
    // Vulkan has no empty buffers; an empty list still needs something to bind.
    const uint64_t held = std::max<uint64_t>(bytes, 16);
    return {{add_resource({name, ResourceKind::kBuffer, false, need_of(held)}, {{}, {}, {}, held}), 0}};
}

ImageId FrameGraph::create_image(const std::string& name, ImageShape shape) {
    if (shape.extent.area() == 0) throw Error("the image '", name, "' has no pixels: ", shape.extent);
    return {{add_resource({name, ResourceKind::kImage, false, need_of(shape)}, {{}, {}, shape, 0}), 0}};
}

void FrameGraph::add_transfer(const std::string& name, uint32_t resource, Use use, Work work) {
    description_.passes.push_back({name, {{resource, versions_[resource], use}}});
    if (writes(use)) ++versions_[resource];
    work_.push_back(std::move(work));
}

void FrameGraph::check_range(const char* transfer, BufferId id, uint64_t offset, uint64_t bytes) const {
    const std::string& name = description_.resources[id.resource].name;
    const Physical& physical = physical_[id.resource];
    if (physical.buffers.size() > 1) {
        throw Error("the ", transfer, " '", name, "' spans ", physical.buffers.size(),
                    " chunks; it can have one alone");
    }
    if (bytes > physical.bytes || offset > physical.bytes - bytes) {
        throw Error("the ", transfer, " '", name, "' takes ", bytes, " bytes from byte ", offset, ", of ",
                    physical.bytes);
    }
}

BufferId FrameGraph::upload_bytes(BufferId id, uint64_t offset, std::span<const std::byte> bytes, bool whole) {
    const std::string& name = description_.resources[id.resource].name;
    check_range("upload to", id, offset, bytes.size());
    if (bytes.empty()) return whole ? fill(id, 0) : id;
    const Staging staging = runner_->stage(bytes.size());
    std::memcpy(staging.mapped, bytes.data(), bytes.size());
    add_transfer("upload." + name, id.resource, whole ? Use::kTransferWrite : Use::kTransferModify,
                 work::Upload{id.resource, offset, bytes.size(), staging});
    return {{id.resource, versions_[id.resource]}};
}

ImageId FrameGraph::upload(const std::string& name, ImageShape shape, std::span<const std::byte> pixels) {
    return upload(create_image(name, shape), pixels);
}

ImageId FrameGraph::upload(ImageId id, std::span<const std::byte> pixels) {
    const std::string& name = description_.resources[id.resource].name;
    const ImageShape image = shape(id);
    const uint64_t expected = image.extent.area() * vulkan::bytes_per_pixel(image.format);
    if (pixels.size() != expected)
        throw Error("the upload to '", name, "' has ", pixels.size(), " bytes, the image ", expected);
    const Staging staging = runner_->stage(pixels.size());
    std::memcpy(staging.mapped, pixels.data(), pixels.size());
    add_transfer("upload." + name, id.resource, Use::kTransferWrite,
                 work::Upload{id.resource, 0, pixels.size(), staging});
    return {{id.resource, versions_[id.resource]}};
}

BufferId FrameGraph::fill(BufferId id, uint32_t value, uint64_t bytes) {
    add_transfer("fill." + description_.resources[id.resource].name, id.resource, Use::kTransferWrite,
                 work::Fill{id.resource, value, bytes});
    return {{id.resource, versions_[id.resource]}};
}

BufferId FrameGraph::copy(BufferId source, uint64_t source_offset, BufferId destination, uint64_t destination_offset,
                          uint64_t bytes) {
    const std::string name = "copy." + description_.resources[destination.resource].name;
    if (source.resource == destination.resource) throw Error("the pass '", name, "' copies a buffer onto itself");
    check_range("copy from", source, source_offset, bytes);
    check_range("copy to", destination, destination_offset, bytes);
    description_.passes.push_back({name,
                                   {{source.resource, source.version, Use::kTransferRead},
                                    {destination.resource, destination.version, Use::kTransferModify}}});
    work_.push_back(work::Copy{source.resource, destination.resource, source_offset, destination_offset, bytes});
    return {{destination.resource, ++versions_[destination.resource]}};
}

Readback FrameGraph::read_back(BufferId id, uint64_t offset, uint64_t bytes) {
    const std::string name = description_.resources[id.resource].name;
    check_range("read-back of", id, offset, bytes);
    Readback target;
    target.state_ = std::make_shared<Readback::State>();
    target.state_->name = name;
    // The host's buffer is a resource of its own, so that the pass has something to keep.
    const BufferId host{{add_resource({"read_back." + name, ResourceKind::kBuffer, true, {}}, {}), 0}};
    description_.passes.push_back(
        {"read_back." + name,
         {{id.resource, id.version, Use::kTransferRead}, {host.resource, 0, Use::kTransferWrite}}});
    ++versions_[host.resource];
    work_.push_back(work::Download{id.resource, offset, bytes, target});
    keep({host.resource, 1});
    return target;
}

Readback FrameGraph::read_back(BufferId id) { return read_back(id, 0, physical_[id.resource].bytes); }

Readback FrameGraph::read_back(ImageId id) {
    const ImageShape image = shape(id);  // a copy: read_back() below adds a resource, which moves all others
    // Images have no byte size of their own; the check above must not see one.
    physical_[id.resource].bytes = image.extent.area() * vulkan::bytes_per_pixel(image.format);
    Readback target = read_back(BufferId{id}, 0, physical_[id.resource].bytes);
    target.state_->extent = image.extent;
    return target;
}

Readback FrameGraph::read_back_pixel(ImageId id, glm::uvec2 pixel) {
    const ImageShape image = shape(id);
    if (pixel.x >= image.extent.width || pixel.y >= image.extent.height)
        throw Error("the read-back of '", description_.resources[id.resource].name, "' takes pixel ", pixel.x, ", ",
                    pixel.y, " of ", image.extent);
    const Readback target = read_back(id);
    auto& download = std::get<work::Download>(work_.back());
    download.bytes = vulkan::bytes_per_pixel(image.format);
    download.pixel = pixel;
    target.state_->extent = {1, 1};
    return target;
}

void FrameGraph::keep(ResourceId id) { description_.kept.push_back({id.resource, id.version}); }

ImageShape FrameGraph::shape(ImageId id) const { return physical_[id.resource].shape; }

uint64_t FrameGraph::bytes(BufferId id) const { return physical_[id.resource].bytes; }

Extent2D FrameGraph::common_extent(std::initializer_list<ImageId> ids) const {
    const ImageId first = *ids.begin();
    for (const ImageId id : ids) {
        if (shape(id).extent != shape(first).extent) {
            throw Error("the image '", description_.resources[id.resource].name, "' has ", shape(id).extent,
                        " pixels, '", description_.resources[first.resource].name, "' has ", shape(first).extent);
        }
    }
    return shape(first).extent;
}

}  // namespace patina::graph
