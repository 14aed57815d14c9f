#include "reconstruction/store/state_files.h"

#include <algorithm>
#include <functional>

namespace patina {

namespace {

/// Of the device's memory on its way from or to the file.
constexpr uint64_t kWindowBytes = uint64_t{8} << 20;

uint64_t total_bytes(const std::vector<vulkan::BufferRef>& chunks) {
    uint64_t bytes = 0;
    for (const vulkan::BufferRef& chunk : chunks) bytes += chunk->bytes();
    return bytes;
}

/// Pieces of an array of `bytes`: their number and size.
uint64_t piece_count(uint64_t bytes) { return (bytes + MapFile::kPieceBytes - 1) / MapFile::kPieceBytes; }
uint64_t piece_bytes(uint64_t bytes, uint64_t piece) {
    return std::min(MapFile::kPieceBytes, bytes - piece * MapFile::kPieceBytes);
}

/// Calls `part` with each chunk that a range of the array lies in, with where it begins there and its bytes.
void for_each_part(const std::vector<vulkan::BufferRef>& chunks, uint64_t begin, uint64_t bytes,
                   const std::function<void(const vulkan::BufferRef&, uint64_t, uint64_t)>& part) {
    uint64_t chunk_begin = 0;
    for (const vulkan::BufferRef& chunk : chunks) {
        const uint64_t from = std::max(begin, chunk_begin), to = std::min(begin + bytes, chunk_begin + chunk->bytes());
        if (from < to) part(chunk, from - chunk_begin, to - from);
        chunk_begin += chunk->bytes();
    }
}

}  // namespace

graph::FrameGraph& StateTransfer::frame() {
    if (!frame_) frame_.emplace(runner_.begin());
    return *frame_;
}

bool StateTransfer::is_full_with(uint64_t bytes) { return (frame_bytes_ += bytes) >= kWindowBytes; }

bool StateTransfer::submit() {
    if (!frame_) return false;
    runner_.submit(*std::move(frame_));
    frame_.reset();
    frame_bytes_ = 0;
    runner_.wait();
    runner_.forget_shapes();
    return true;
}

void StateWriter::flush() {
    if (!submit()) return;
    for (; !pending_.empty(); pending_.pop_front()) {
        const Pending& pending = pending_.front();
        if (pending.parts.size() == 1) {
            map_.set_piece(pending.array, pending.piece, pending.parts.front().bytes());
            continue;
        }
        std::vector<std::byte> content;
        for (const graph::Readback& part : pending.parts)
            content.insert(content.end(), part.bytes().begin(), part.bytes().end());
        map_.set_piece(pending.array, pending.piece, content);
    }
}

void StateWriter::begin(const std::string& name, uint64_t bytes) {
    if (!names_.insert(name).second) throw Error("two parts of the state are called '", name, "'");
    map_.set_bytes(name, bytes);
}

void StateWriter::chunks(const std::string& name, const std::vector<vulkan::BufferRef>& chunks) {
    const uint64_t bytes = total_bytes(chunks);
    begin(name, bytes);
    for (uint64_t piece = 0; piece < piece_count(bytes); ++piece) {
        Pending& pending = pending_.emplace_back(Pending{name, piece, {}});
        for_each_part(chunks, piece * MapFile::kPieceBytes, piece_bytes(bytes, piece),
                      [&](const vulkan::BufferRef& chunk, uint64_t begin, uint64_t size) {
                          pending.parts.push_back(frame().read_back(frame().import(chunk), begin, size));
                      });
        if (is_full_with(piece_bytes(bytes, piece))) flush();
    }
}

void StateWriter::buffer(vulkan::BufferRef& buffer) { chunks(buffer->desc().name, {buffer}); }

void StateWriter::array(vulkan::ChunkedBuffer& array) { chunks(array.name(), array.chunks()); }

void StateWriter::image(vulkan::ImageRef& image) {
    const graph::Readback read = frame().read_back(frame().import(image));
    flush();
    auto pixels = read.as<std::byte>();
    bytes(image->desc().name, pixels);
}

void StateWriter::bytes(const std::string& name, std::vector<std::byte>& bytes) {
    begin(name, bytes.size());
    for (uint64_t piece = 0; piece < piece_count(bytes.size()); ++piece) {
        map_.set_piece(name, piece,
                       std::span(bytes).subspan(piece * MapFile::kPieceBytes, piece_bytes(bytes.size(), piece)));
    }
}

void StateReader::flush() {
    for (const vulkan::BufferRef& buffer : written_) frame().keep(frame().import(buffer));
    written_.clear();
    submit();
}

void StateReader::chunks(const std::string& name, const std::vector<vulkan::BufferRef>& chunks) {
    const uint64_t bytes = total_bytes(chunks);
    for (uint64_t piece = 0; piece < piece_count(bytes); ++piece) {
        const std::vector<std::byte> content = map_.piece(name, piece);
        if (content.size() != piece_bytes(bytes, piece))
            throw Error("'", map_.file().string(), "': piece ", piece, " of '", name, "' has ", content.size(),
                        " bytes, not ", piece_bytes(bytes, piece));
        size_t taken = 0;
        for_each_part(chunks, piece * MapFile::kPieceBytes, content.size(),
                      [&](const vulkan::BufferRef& chunk, uint64_t begin, uint64_t size) {
                          const std::span part = std::span(content).subspan(taken, size);
                          frame().upload_bytes(frame().import(chunk), begin, part, false);
                          if (written_.empty() || written_.back() != chunk) written_.push_back(chunk);
                          taken += size;
                      });
        if (is_full_with(content.size())) flush();
    }
}

void StateReader::buffer(vulkan::BufferRef& buffer) {
    vulkan::BufferDesc desc = buffer->desc();
    desc.bytes = map_.bytes(desc.name);
    if (desc.bytes == 0) throw Error("'", map_.file().string(), "': '", desc.name, "' is empty");
    if (desc.bytes != buffer->bytes()) buffer = runner_.device().create_buffer(desc);
    chunks(desc.name, {buffer});
}

void StateReader::array(vulkan::ChunkedBuffer& array) {
    const uint64_t bytes = map_.bytes(array.name()), elements = bytes / array.bytes_per_element();
    if (elements * array.bytes_per_element() != bytes || elements < array.elements())
        throw Error("'", map_.file().string(), "': '", array.name(), "' has ", bytes, " bytes, at least ",
                    array.bytes(), " in elements of ", array.bytes_per_element(), " were expected");
    if (elements > array.elements()) array = array.with_room_for(elements);
    chunks(array.name(), array.chunks());
}

void StateReader::image(vulkan::ImageRef& image) {
    const std::vector<std::byte> pixels = all_of(image->desc().name);
    frame().keep(frame().upload(frame().import(image), pixels));
    flush();
}

void StateReader::bytes(const std::string& name, std::vector<std::byte>& bytes) { bytes = all_of(name); }

std::vector<std::byte> StateReader::all_of(const std::string& name) {
    const uint64_t bytes = map_.bytes(name);
    std::vector<std::byte> all;
    for (uint64_t piece = 0; piece < piece_count(bytes); ++piece) {
        const std::vector<std::byte> content = map_.piece(name, piece);
        all.insert(all.end(), content.begin(), content.end());
    }
    if (all.size() != bytes)
        throw Error("'", map_.file().string(), "': '", name, "' has ", all.size(), " bytes, not ", bytes);
    return all;
}

}  // namespace patina
