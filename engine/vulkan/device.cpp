#include "engine/vulkan/device.h"

#include <algorithm>

#include "engine/vulkan/context.h"

namespace patina::vulkan {

namespace {

using Memory = vk::MemoryPropertyFlagBits;

struct Properties {
    vk::MemoryPropertyFlags required;
    vk::MemoryPropertyFlags preferred;
};

Properties properties_of(MemoryKind kind) {
    switch (kind) {
        case MemoryKind::kDevice: return {{}, Memory::eDeviceLocal};
        case MemoryKind::kUpload: return {Memory::eHostVisible | Memory::eHostCoherent, {}};
        case MemoryKind::kReadback: return {Memory::eHostVisible | Memory::eHostCoherent, Memory::eHostCached};
    }
    return {};
}

}  // namespace

vk::BufferCreateInfo create_info(const BufferDesc& desc) {
    using Usage = vk::BufferUsageFlagBits;
    return {{},
            std::max<uint64_t>(desc.bytes, 4),
            Usage::eStorageBuffer | Usage::eUniformBuffer | Usage::eIndirectBuffer | Usage::eTransferSrc |
                Usage::eTransferDst | Usage::eStorageTexelBuffer};
}

vk::ImageCreateInfo create_info(const ImageDesc& desc) {
    using Usage = vk::ImageUsageFlagBits;
    vk::ImageUsageFlags usage = Usage::eStorage | Usage::eSampled | Usage::eTransferSrc | Usage::eTransferDst;
    if (desc.composed) usage |= Usage::eColorAttachment;
    return {{},
            vk::ImageType::e2D,
            vk_format(desc.format),
            vk::Extent3D(desc.extent.width, desc.extent.height, 1),
            1,
            1,
            vk::SampleCountFlagBits::e1,
            vk::ImageTiling::eOptimal,
            usage};
}

MemoryObject::~MemoryObject() {
    if (context) context->note_memory(-static_cast<int64_t>(bytes));
}

Buffer::Buffer(std::unique_ptr<BufferObject> object)
    : object_(std::move(object)),
      desc_(object_->desc),
      serial_(object_->context->next_serial()),
      mapped_(object_->mapped) {}
Buffer::~Buffer() = default;

DeviceImage::DeviceImage(std::unique_ptr<ImageObject> object)
    : object_(std::move(object)), desc_(object_->desc), serial_(object_->context->next_serial()) {}
DeviceImage::~DeviceImage() = default;

vk::BufferView BufferObject::texel_view(Format format) {
    auto found = texel_views.find(format);
    if (found == texel_views.end()) {
        const uint64_t elements = desc.bytes / bytes_per_pixel(format);
        if (elements > context->caps().max_texel_elements) {
            throw Error("the buffer '", desc.name, "' has ", elements, " texels, the device allows ",
                        context->caps().max_texel_elements);
        }
        vk::raii::BufferView made =
            context->device().createBufferView({{}, *buffer, vk_format(format), 0, VK_WHOLE_SIZE});
        context->set_name(made, desc.name + ".texels");
        found = texel_views.emplace(format, std::move(made)).first;
    }
    return *found->second;
}

Device::Device(const DeviceOptions& options) : context_(std::make_shared<Context>(options)) {}
Device::~Device() = default;

const DeviceCaps& Device::caps() const { return context_->caps(); }

BufferRef Device::create_placed_buffer(const BufferDesc& desc, const MemoryRef& memory, uint64_t offset) {
    return guarded(text("creating the buffer '", desc.name, "' of ", desc.bytes, " bytes"), [&] {
        auto object = std::make_unique<BufferObject>();
        object->context = context_;
        object->memory = memory;
        object->desc = desc;
        object->buffer = context_->device().createBuffer(create_info(desc));
        object->buffer.bindMemory(*memory->memory, offset);
        if (desc.memory != MemoryKind::kDevice) {
            object->mapped = static_cast<std::byte*>(memory->memory.mapMemory(offset, VK_WHOLE_SIZE));
        }
        context_->set_name(object->buffer, desc.name);
        return std::make_shared<Buffer>(std::move(object));
    });
}

ImageRef Device::create_placed_image(const ImageDesc& desc, const MemoryRef& memory, uint64_t offset) {
    return guarded(text("creating the image '", desc.name, "' of ", desc.extent, " pixels"), [&] {
        auto object = std::make_unique<ImageObject>();
        object->context = context_;
        object->memory = memory;
        object->desc = desc;
        object->image = context_->device().createImage(create_info(desc));
        object->image.bindMemory(*memory->memory, offset);
        object->view = context_->device().createImageView({{},
                                                           *object->image,
                                                           vk::ImageViewType::e2D,
                                                           vk_format(desc.format),
                                                           {},
                                                           {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1}});
        context_->set_name(object->image, desc.name);
        context_->set_name(object->view, desc.name + ".view");
        return std::make_shared<DeviceImage>(std::move(object));
    });
}

namespace {

vk::MemoryRequirements requirements(Context& context, const BufferDesc& desc) {
    const auto info = create_info(desc);
    return context.device().getBufferMemoryRequirements(vk::DeviceBufferMemoryRequirements(&info)).memoryRequirements;
}

vk::MemoryRequirements requirements(Context& context, const ImageDesc& desc) {
    const auto info = create_info(desc);
    return context.device().getImageMemoryRequirements(vk::DeviceImageMemoryRequirements(&info)).memoryRequirements;
}

MemoryRef allocate(const std::shared_ptr<Context>& context, const std::string& name,
                   const vk::MemoryRequirements& needs, MemoryKind kind) {
    const Properties properties = properties_of(kind);
    auto memory = std::make_shared<MemoryObject>();
    memory->memory =
        context->allocate(name, needs.size, needs.memoryTypeBits, properties.required, properties.preferred);
    memory->bytes = needs.size;
    memory->context = context;
    context->note_memory(static_cast<int64_t>(needs.size));
    return memory;
}

/// Brings an image of its own memory into the general layout, in which it stays.
void initialise_layout(Context& context, vk::Image image) {
    const vk::ImageMemoryBarrier2 barrier(
        vk::PipelineStageFlagBits2::eNone, {}, vk::PipelineStageFlagBits2::eAllCommands,
        vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite, vk::ImageLayout::eUndefined,
        vk::ImageLayout::eGeneral, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, image,
        {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1});
    const vk::DependencyInfo info({}, {}, {}, barrier);
    submit_and_wait(context, [&](vk::CommandBuffer commands) {
        commands.pipelineBarrier2(info, *context.device().getDispatcher());
    });
}

}  // namespace

void submit_and_wait(Context& context, const std::function<void(vk::CommandBuffer)>& record) {
    const vk::raii::Device& device = context.device();
    const vk::raii::CommandPool pool =
        device.createCommandPool({vk::CommandPoolCreateFlagBits::eTransient, context.queue_family()});
    const vk::raii::CommandBuffers buffers(device, {*pool, vk::CommandBufferLevel::ePrimary, 1});
    const vk::raii::CommandBuffer& commands = buffers.front();
    commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    record(*commands);
    commands.end();
    const vk::CommandBufferSubmitInfo submitted(*commands);
    context.queue().submit2(vk::SubmitInfo2({}, {}, submitted));
    context.queue().waitIdle();
}

BufferRef Device::create_buffer(const BufferDesc& desc) {
    if (desc.bytes > caps().max_allocation) {
        throw OutOfMemory("the buffer '", desc.name, "' needs ", desc.bytes, " bytes, the device allocates at most ",
                          caps().max_allocation, " at once");
    }
    const MemoryRef memory = allocate(context_, desc.name, requirements(*context_, desc), desc.memory);
    return create_placed_buffer(desc, memory, 0);
}

ImageRef Device::create_image(const ImageDesc& desc) {
    const MemoryRef memory = allocate(context_, desc.name, requirements(*context_, desc), MemoryKind::kDevice);
    ImageRef image = create_placed_image(desc, memory, 0);
    guarded(text("preparing the image '", desc.name, "'"),
            [&] { initialise_layout(*context_, *image->object().image); });
    return image;
}

MemoryRef Device::create_memory(const std::string& name, uint64_t bytes, bool for_images) {
    vk::MemoryRequirements needs = for_images ? requirements(*context_, ImageDesc{name, {1, 1}, Format::kR32f})
                                              : requirements(*context_, BufferDesc{name, 4});
    needs.size = bytes;
    return allocate(context_, name, needs, MemoryKind::kDevice);
}

MemoryRequirement Device::requirement(const BufferDesc& desc) const {
    const auto needs = requirements(*context_, desc);
    return {needs.size, needs.alignment};
}

MemoryRequirement Device::requirement(const ImageDesc& desc) const {
    const auto needs = requirements(*context_, desc);
    return {needs.size, needs.alignment};
}

uint64_t Device::available_memory() const { return context_->available_memory(); }

uint64_t Device::held_memory() const { return context_->held_memory(); }

void Device::wait_idle() {
    guarded("waiting for the device", [&] { context_->device().waitIdle(); });
}

std::vector<std::string> Device::validation_messages() const {
    const std::scoped_lock lock(context_->validation_log().mutex);
    return context_->validation_log().messages;
}

ChunkedBuffer::ChunkedBuffer(Device& device, const std::string& name, uint64_t elements, uint32_t bytes_per_element,
                             uint64_t chunk_elements, uint32_t max_chunks)
    : device_(&device),
      name_(name),
      bytes_per_element_(bytes_per_element),
      chunk_elements_(chunk_elements),
      max_chunks_(max_chunks) {
    const uint64_t most_bytes = chunk_elements * bytes_per_element;
    if (most_bytes > device.caps().max_storage_range) {
        throw Error("a chunk of the array '", name, "' takes ", most_bytes, " bytes, the device binds at most ",
                    device.caps().max_storage_range);
    }
    add_chunks(elements);
}

uint64_t ChunkedBuffer::chunk_bytes(uint64_t chunk, uint64_t elements) const {
    return std::min(chunk_elements_, elements - chunk * chunk_elements_) * bytes_per_element_;
}

void ChunkedBuffer::add_chunks(uint64_t elements) {
    const uint64_t needed = std::max<uint64_t>((elements + chunk_elements_ - 1) / chunk_elements_, 1);
    if (needed > max_chunks_)
        throw Error("the array '", name_, "' needs ", needed, " chunks, at most ", max_chunks_, " can be bound");
    elements_ = elements;
    for (uint64_t i = chunks_.size(); i < needed; ++i)
        chunks_.push_back(device_->create_buffer({text(name_, '[', i, ']'), chunk_bytes(i, elements)}));
}

ChunkedBuffer ChunkedBuffer::with_room_for(uint64_t elements) const {
    PATINA_ASSERT(elements >= elements_, "the array '", name_, "' shrinks from ", elements_, " to ", elements);
    ChunkedBuffer larger = *this;
    if (chunk_bytes(chunks_.size() - 1, elements) != chunks_.back()->bytes()) larger.chunks_.pop_back();
    larger.add_chunks(elements);
    return larger;
}

uint64_t ChunkedBuffer::bytes_to_make(uint64_t elements) const {
    const uint64_t last = chunks_.size() - 1;
    const bool replaced = chunk_bytes(last, elements) != chunks_.back()->bytes();
    return elements * bytes_per_element_ - bytes() + (replaced ? chunks_.back()->bytes() : 0);
}

uint64_t ChunkedBuffer::bytes() const {
    uint64_t total = 0;
    for (const BufferRef& chunk : chunks_) total += chunk->bytes();
    return total;
}

}  // namespace patina::vulkan
