#include "reconstruction/streaming/packer.h"

#include <new>

#include <zstd.h>

#include "engine/core/error.h"

namespace patina {

namespace {

constexpr int kLevel = 1;

template <class Context>
Context* made(Context* context) {
    if (!context) throw std::bad_alloc();
    return context;
}

}  // namespace

void Packer::Free::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }
void Packer::Free::operator()(ZSTD_DCtx_s* context) const { ZSTD_freeDCtx(context); }

Packer::Packer() : compressor_(made(ZSTD_createCCtx())), decompressor_(made(ZSTD_createDCtx())) {}
Packer::~Packer() = default;

std::vector<std::byte> Packer::pack(std::span<const uint32_t> words) {
    bytes_.resize(words.size() * 4);
    for (size_t b = 0; b < 4; ++b) {
        std::byte* const out = bytes_.data() + b * words.size();
        for (size_t i = 0; i < words.size(); ++i) out[i] = static_cast<std::byte>(words[i] >> 8 * b);
    }
    packed_.resize(ZSTD_compressBound(bytes_.size()));
    const size_t size =
        ZSTD_compressCCtx(compressor_.get(), packed_.data(), packed_.size(), bytes_.data(), bytes_.size(), kLevel);
    if (ZSTD_isError(size)) throw std::bad_alloc();
    return {packed_.begin(), packed_.begin() + static_cast<std::ptrdiff_t>(size)};
}

std::vector<uint32_t> Packer::unpack(std::span<const std::byte> packed, size_t most) {
    bytes_.resize(most * 4);
    const size_t size =
        ZSTD_decompressDCtx(decompressor_.get(), bytes_.data(), bytes_.size(), packed.data(), packed.size());
    if (ZSTD_isError(size)) throw Error("is damaged: ", ZSTD_getErrorName(size));
    if (size % 4 != 0) throw Error("has ", size, " bytes, which are no words");
    std::vector<uint32_t> words(size / 4);
    for (size_t b = 0; b < 4; ++b) {
        const std::byte* const in = bytes_.data() + b * words.size();
        for (size_t i = 0; i < words.size(); ++i) words[i] |= std::to_integer<uint32_t>(in[i]) << 8 * b;
    }
    return words;
}

}  // namespace patina
