#include "reconstruction/streaming/record_codec.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

#include "engine/core/error.h"

namespace patina {

namespace {

constexpr size_t kOwnWords = sizeof(gpu::StreamedRecord) / sizeof(uint32_t);
constexpr size_t kRecordWords = kOwnWords + 2 * kObservationWords;
constexpr size_t kMostRecords = 64;  // in a block

using OwnWords = std::array<uint32_t, kOwnWords>;
using AllWords = std::array<uint32_t, kRecordWords>;

uint32_t voxel_of(const gpu::StreamedRecord& record) { return record.record.state >> 5 & 0x3f; }
uint32_t observations_of(const gpu::StreamedRecord& record) { return record.record.state & 0x1f; }

/// Whether a word of the directions holds anything. The closest pair is one from two observations on.
bool is_used(size_t word, uint32_t observations) {
    return word < gpu::kMaxObservations ? word < observations : observations >= 2;
}

AllWords words_of(const RecordWords& words, size_t record, BlockStore::Kept& kept) {
    gpu::StreamedRecord own = words.records[record];
    const uint32_t observations = observations_of(own);
    own.record.block_key = 0;
    own.record.label = kept.with_place(own.record.label);
    AllWords all{};
    std::memcpy(all.data(), &own, sizeof(own));
    for (size_t i = 0; i < kObservationWords; ++i) {
        const size_t from = record * kObservationWords + i;
        if (is_used(i, observations)) all[kOwnWords + i] = words.directions[from];
        if (i < observations) all[kOwnWords + kObservationWords + i] = words.colors[from];
    }
    return all;
}

}  // namespace

BlockStore::Kept pack_records(Packer& packer, const RecordWords& words) {
    const size_t count = words.records.size();
    std::vector<size_t> order(count);
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return voxel_of(words.records[a]) < voxel_of(words.records[b]); });
    BlockStore::Kept kept;
    // All records' first words, then their second ones, and so on: they are alike.
    std::vector<uint32_t> all(count * kRecordWords);
    for (size_t i = 0; i < count; ++i) {
        const AllWords own = words_of(words, order[i], kept);
        for (size_t word = 0; word < kRecordWords; ++word) all[word * count + i] = own[word];
    }
    kept.packed = packer.pack(all);
    return kept;
}

uint32_t count_records(const BlockStore::Kept& kept) {
    return std::accumulate(kept.labels.begin(), kept.labels.end(), 0u,
                           [](uint32_t sum, const BlockStore::Kept::Label& label) { return sum + label.voxels; });
}

void unpack_records(Packer& packer, const BlockStore& store, uint32_t key, uint32_t place, UnpackedRecords& to) {
    const BlockStore::Kept& kept = store.at(key);
    const size_t count = count_records(kept);
    std::vector<uint32_t> all;
    try {
        all = packer.unpack(store.packed(key), kMostRecords * kRecordWords);
        if (all.size() != count * kRecordWords) throw Error("has ", all.size(), " words, not ", count * kRecordWords);
    } catch (const Error& error) {
        throw Error("a block of observed voxels, ", key, ", which was away, ", error.what());
    }
    for (size_t i = 0; i < count; ++i) {
        AllWords words;
        for (size_t word = 0; word < kRecordWords; ++word) words[word] = all[word * count + i];
        gpu::StreamedRecord& own = to.records.emplace_back();
        std::memcpy(&own, words.data(), sizeof(own));
        own.record.block_key = place;
        own.record.label = kept.with_label(own.record.label);
        const auto observed = words.begin() + kOwnWords;
        to.directions.insert(to.directions.end(), observed, observed + kObservationWords);
        to.colors.insert(to.colors.end(), observed + kObservationWords, words.end());
    }
}

}  // namespace patina
