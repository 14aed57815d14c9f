#include "export/glb_file.h"

#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "engine/core/error.h"

namespace patina {

namespace {

constexpr uint64_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr uint32_t kMagic = 0x4654'6c67, kGlbVersion = 2, kJsonChunk = 0x4e4f'534a, kBufferChunk = 0x004e'4942;
constexpr size_t kCopiedAtOnce = 1 << 20;

constexpr uint64_t aligned(uint64_t bytes) { return (bytes + 3) / 4 * 4; }

/// Little-endian, whatever the machine is.
void write_word(sensor::NewFile& file, uint64_t word) {
    char bytes[4];
    for (size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(word >> 8 * i & 0xff);
    file.write({bytes, sizeof(bytes)});
}

/// The model's JSON, with one buffer of so many bytes in the file, or none.
std::string json_of(tinygltf::Model& model, uint64_t buffer_bytes) {
    constexpr bool kPretty = false, kBinary = false;
    model.buffers.clear();
    std::ostringstream text;
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, text, kPretty, kBinary))
        throw Error("the scene has no JSON form");
    auto json = nlohmann::json::parse(text.str());
    if (buffer_bytes > 0) json["buffers"] = nlohmann::json::array({{{"byteLength", buffer_bytes}}});
    return json.dump();
}

}  // namespace

GlbFile::GlbFile(std::filesystem::path path, uint64_t most_bytes)
    : path_(std::move(path)), buffer_path_(path_.string() + ".buffer"), most_bytes_(most_bytes) {
    buffer_.emplace(buffer_path_);
}

GlbFile::~GlbFile() { unlink(buffer_path_.c_str()); }

/// The whole file's. Throws Error where that is too much.
uint64_t GlbFile::length_with(uint64_t json_bytes, uint64_t buffer_bytes) const {
    const uint64_t buffer_chunk = buffer_bytes > 0 ? kChunkHeaderBytes + aligned(buffer_bytes) : 0;
    const uint64_t length = kHeaderBytes + kChunkHeaderBytes + aligned(json_bytes) + buffer_chunk;
    if (length > most_bytes_)
        throw Error(path_, ": a GLB file holds at most ", most_bytes_, " bytes, but the scene needs ", length,
                    " or more");
    return length;
}

uint64_t GlbFile::append(std::span<const std::byte> bytes) {
    length_with(0, aligned(buffer_->position()) + bytes.size());
    buffer_->write(std::string(aligned(buffer_->position()) - buffer_->position(), '\0'));
    const uint64_t first = buffer_->position();
    buffer_->write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return first;
}

void GlbFile::finish(tinygltf::Model& model) {
    const uint64_t bytes = buffer_->position();
    buffer_->close();
    const std::string json = json_of(model, bytes);
    const uint64_t length = length_with(json.size(), bytes);
    sensor::NewFile file(path_);
    write_word(file, kMagic);
    write_word(file, kGlbVersion);
    write_word(file, length);
    write_word(file, aligned(json.size()));
    write_word(file, kJsonChunk);
    file.write(json);
    file.write(std::string(aligned(json.size()) - json.size(), ' '));
    if (bytes > 0) {
        write_word(file, aligned(bytes));
        write_word(file, kBufferChunk);
        const uint64_t first = file.position();
        copy_buffer(file);
        if (file.position() - first != bytes)
            throw Error(buffer_path_, ": ", file.position() - first, " bytes can be read back, not ", bytes);
        file.write(std::string(aligned(bytes) - bytes, '\0'));
    }
    file.close();
}

void GlbFile::copy_buffer(sensor::NewFile& file) const {
    std::ifstream buffer(buffer_path_, std::ios::binary);
    for (std::string some(kCopiedAtOnce, '\0'); buffer;) {
        buffer.read(some.data(), static_cast<std::streamsize>(some.size()));
        file.write({some.data(), static_cast<size_t>(buffer.gcount())});
    }
}

}  // namespace patina
