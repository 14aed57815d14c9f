#include "engine/graph/enlargement.h"

#include "engine/vulkan/device.h"

namespace patina::graph {

namespace {

/// Copies all of `from` to byte `offset` of `to`.
void copy_whole(FrameGraph& frame, const vulkan::BufferRef& from, const vulkan::BufferRef& to, uint64_t offset) {
    frame.copy(frame.import(from), 0, frame.import(to), offset, from->bytes());
}

}  // namespace

void Enlargement::add(vulkan::BufferRef& buffer, uint64_t bytes, const EnlargedContent& content) {
    const uint64_t needed = content.kept ? content.offset + buffer->bytes() : 0;
    PATINA_ASSERT(bytes >= needed, "the buffer '", buffer->desc().name, "' of ", needed, " bytes is enlarged to ",
                  bytes);
    singles_.push_back({&buffer, bytes, content});
}

void Enlargement::add(vulkan::ChunkedBuffer& array, uint64_t elements) { arrays_.push_back({&array, elements}); }

uint64_t Enlargement::bytes() const {
    uint64_t total = 0;
    for (const Single& single : singles_) total += single.bytes;
    for (const Array& each : arrays_) total += each.array->bytes_to_make(each.elements);
    return total;
}

void Enlargement::allocate() {
    for (Single& single : singles_)
        single.larger = device_->create_buffer({(*single.buffer)->desc().name, single.bytes});
    for (Array& each : arrays_) each.larger = each.array->with_room_for(each.elements);
}

void Enlargement::commit(FrameGraph& frame) {
    for (const Single& single : singles_) {
        if (single.content.fill) frame.fill(frame.import(single.larger), *single.content.fill);
        if (single.content.kept) copy_whole(frame, *single.buffer, single.larger, single.content.offset);
        if (single.content.fill || single.content.kept) committed_.push_back(single.larger);
    }
    for (const Array& each : arrays_) {
        const auto& before = each.array->chunks();
        const vulkan::BufferRef& last = before.back();
        const vulkan::BufferRef& now = each.larger.chunks()[before.size() - 1];
        if (now == last) continue;
        copy_whole(frame, last, now, 0);
        committed_.push_back(now);
    }
    exchange();
    exchanged_ = true;
}

/// Puts the larger buffers in the places of those before, or back.
void Enlargement::exchange() {
    for (Single& single : singles_) std::swap(*single.buffer, single.larger);
    for (Array& each : arrays_) std::swap(*each.array, each.larger);
    for (const auto& exchange : exchanges_) exchange();
}

Enlargement::~Enlargement() {
    if (exchanged_) exchange();  // of what was moved from, nothing is left
}

void Enlargement::accept() {
    exchanged_ = false;
    singles_.clear();
    arrays_.clear();
    exchanges_.clear();
}

void Enlargement::keep(FrameGraph& frame) const {
    for (const vulkan::BufferRef& buffer : committed_) frame.keep(frame.import(buffer));
}

}  // namespace patina::graph
