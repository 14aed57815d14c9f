#include "engine/store/content_digest.h"

#include <bit>
#include <cstring>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace patina {

namespace {

ContentDigest canonical(XXH128_hash_t hash) {
    XXH128_canonical_t bytes;
    XXH128_canonicalFromHash(&bytes, hash);
    ContentDigest digest;
    std::memcpy(digest.data(), bytes.digest, digest.size());
    return digest;
}

}  // namespace

ContentDigest digest_of(std::span<const std::byte> content) {
    return canonical(XXH3_128bits(content.data(), content.size()));
}

struct RowDigest::State {
    XXH3_state_t hash;
};

RowDigest::RowDigest(std::string_view table) : state_(new State) {
    XXH3_128bits_reset(&state_->hash);
    add(table);
}

RowDigest::~RowDigest() = default;

void RowDigest::add_bytes(const void* bytes, size_t count) { XXH3_128bits_update(&state_->hash, bytes, count); }

RowDigest& RowDigest::add(int64_t number) {
    std::array<unsigned char, 8> little;
    for (size_t i = 0; i < little.size(); ++i)
        little[i] = static_cast<unsigned char>(static_cast<uint64_t>(number) >> 8 * i);
    add_bytes(little.data(), little.size());
    return *this;
}

RowDigest& RowDigest::add(double number) { return add(std::bit_cast<int64_t>(number + 0.0)); }

RowDigest& RowDigest::add(std::string_view text) { return add(std::as_bytes(std::span(text))); }

RowDigest& RowDigest::add(std::span<const std::byte> blob) {
    add(static_cast<int64_t>(blob.size()));
    if (!blob.empty()) add_bytes(blob.data(), blob.size());
    return *this;
}

ContentDigest RowDigest::value() const { return canonical(XXH3_128bits_digest(&state_->hash)); }

}  // namespace patina
