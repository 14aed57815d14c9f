#include "sensor/kinect2/color_assembler.h"

#include <algorithm>
#include <cstring>

#include <gmock/gmock.h>

#include "tests/simulated_kinect2/color_signal.h"
#include "tests/simulated_kinect2/flat_jpeg.h"

namespace patina::sensor::kinect2::testing::color_assembler_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr size_t kTransferBytes = 16384;

SentPicture picture(uint32_t sequence, size_t size = 40000) {
    SentPicture sent;
    sent.jpeg.resize(size);
    uint32_t state = sequence + 1;
    for (uint8_t& byte : sent.jpeg) {
        state = state * 1664525u + 1013904223u;
        byte = static_cast<uint8_t>(state >> 24);
    }
    sent.jpeg[0] = 0xFF;
    sent.jpeg[1] = 0xD8;
    sent.jpeg[size - 2] = 0xFF;
    sent.jpeg[size - 1] = 0xD9;
    sent.sequence = sequence;
    sent.timestamp = 266 * sequence;
    sent.exposure_ms = 12.5f;
    sent.gain = 1.25f;
    sent.gamma = 3;
    sent.filler = 4 * (sequence % 7);
    return sent;
}

using Transfers = std::vector<std::vector<uint8_t>>;

void add(Transfers& transfers, const std::vector<uint8_t>& packet, size_t size = kTransferBytes) {
    for (size_t begin = 0; begin < packet.size(); begin += size) {
        const auto first = packet.begin() + static_cast<std::ptrdiff_t>(begin);
        transfers.emplace_back(first, first + static_cast<std::ptrdiff_t>(std::min(size, packet.size() - begin)));
    }
}

/// The numbers of what came out; each picture must be as it was sent. An empty transfer is one that failed.
std::vector<uint32_t> receive(const Transfers& transfers, ColorStatistics* statistics = nullptr,
                              size_t jpeg_bytes = 40000) {
    ColorAssembler assembler;
    std::vector<uint32_t> sequences;
    ColorFrame frame;
    for (const auto& transfer : transfers) {
        if (!assembler.add(!transfer.empty(), transfer)) continue;
        assembler.take(frame);
        sequences.push_back(frame.sequence);
        const SentPicture sent = picture(frame.sequence, jpeg_bytes);
        EXPECT_EQ(frame.jpeg, sent.jpeg);
        EXPECT_EQ(frame.timestamp, sent.timestamp);
        EXPECT_EQ(frame.exposure_ms, sent.exposure_ms);
        EXPECT_EQ(frame.gain, sent.gain);
        EXPECT_EQ(frame.gamma, sent.gamma);
    }
    if (statistics) *statistics = assembler.statistics();
    return sequences;
}

TEST(Kinect2Color, PicturesOfAllLengthsAndFillersComeOutAsSent) {
    for (size_t bytes = 1000; bytes < 1000 + 9; ++bytes) {  // every padding
        Transfers transfers;
        for (uint32_t n = 0; n < 7; ++n) add(transfers, color_packet(picture(n, bytes)));
        EXPECT_THAT(receive(transfers, nullptr, bytes), ElementsAre(0, 1, 2, 3, 4, 5, 6)) << bytes;
    }
}

TEST(Kinect2Color, PacketThatFillsItsLastTransferIsComplete) {
    for (size_t bytes = 2 * kTransferBytes - 70; bytes <= 2 * kTransferBytes; ++bytes) {
        SentPicture sent = picture(0, bytes);
        sent.filler = 0;
        Transfers transfers;
        add(transfers, color_packet(sent));
        EXPECT_THAT(receive(transfers, nullptr, bytes), ElementsAre(0)) << bytes;
    }
}

TEST(Kinect2Color, SplitAtEveryOffsetAroundTheFooterChangesNothing) {
    const std::vector<uint8_t> first = color_packet(picture(3, 900)), second = color_packet(picture(4, 900));
    const size_t around = 100;  // the footer's 56 bytes, the filler and the end of the JPEG
    for (size_t split = first.size() - around; split < first.size(); ++split) {
        const auto middle = first.begin() + static_cast<std::ptrdiff_t>(split);
        const Transfers transfers{{first.begin(), middle}, {middle, first.end()}, second};
        EXPECT_THAT(receive(transfers, nullptr, 900), ElementsAre(3, 4)) << split;
    }
}

TEST(Kinect2Color, EveryLostTransferCostsItsPictureAlone) {
    const size_t per_picture = color_packet(picture(0)).size() / kTransferBytes + 1;
    for (size_t lost = 0; lost < per_picture; ++lost) {
        for (const bool reported : {false, true}) {
            Transfers transfers;
            for (uint32_t n = 0; n < 4; ++n) add(transfers, color_packet(picture(n)));
            const size_t index = per_picture + lost;
            if (reported) {
                transfers[index].clear();
            } else {
                transfers.erase(transfers.begin() + static_cast<std::ptrdiff_t>(index));
            }
            ColorStatistics statistics;
            EXPECT_THAT(receive(transfers, &statistics), ElementsAre(0, 2, 3)) << lost << reported;
            EXPECT_EQ(statistics.lost_frames, 1u);
            EXPECT_EQ(statistics.lost_transfers, reported ? 1u : 0u);
        }
    }
}

/// Picture 1 of three is damaged by `change`.
std::vector<uint32_t> with_damaged(const std::function<void(std::vector<uint8_t>&)>& change) {
    Transfers transfers;
    for (uint32_t n = 0; n < 3; ++n) {
        std::vector<uint8_t> packet = color_packet(picture(n));
        if (n == 1) change(packet);
        add(transfers, packet);
    }
    return receive(transfers);
}

void set_word(std::vector<uint8_t>& packet, size_t offset, uint32_t word) {
    std::memcpy(packet.data() + offset, &word, sizeof word);
}

TEST(Kinect2Color, WordsThatDisagreeCostTheirPictureAlone) {
    const auto in_footer = [](size_t offset, uint32_t word) {
        return with_damaged([=](auto& packet) { set_word(packet, packet.size() - 56 + offset, word); });
    };
    EXPECT_THAT(with_damaged([](auto& packet) { set_word(packet, 0, 77); }), ElementsAre(0, 2)) << "header's number";
    EXPECT_THAT(with_damaged([](auto& packet) { set_word(packet, 4, 77); }), ElementsAre(0, 2)) << "header's magic";
    EXPECT_THAT(in_footer(0, 77), ElementsAre(0, 2)) << "first magic";
    EXPECT_THAT(in_footer(4, 77), ElementsAre(0, 2)) << "number";
    EXPECT_THAT(in_footer(32, 77), ElementsAre(0, 2)) << "second magic";
    for (const uint32_t word : {0u, 63u, 64u, 40000u, 1u << 20, 0xFFFFFFFFu}) {
        EXPECT_THAT(in_footer(8, word), ElementsAre(0, 2)) << "filler " << word;
        EXPECT_THAT(in_footer(36, word), ElementsAre(0, 2)) << "size " << word;
    }
}

TEST(Kinect2Color, PictureWithoutItsEndOrStartIsDropped) {
    EXPECT_THAT(with_damaged([](auto& packet) { packet[8] = 0; }), ElementsAre(0, 2));
    EXPECT_THAT(with_damaged([](auto& packet) { packet[8 + 40000 - 1] = 0; }), ElementsAre(0, 2));
}

TEST(Kinect2Color, EndlessDataWithoutFooterIsForgotten) {
    Transfers transfers(300, std::vector<uint8_t>(kTransferBytes, 0x42));  // 4.9 MB of what looks like magic words
    ColorStatistics statistics;
    EXPECT_THAT(receive(transfers), IsEmpty());
    add(transfers, color_packet(picture(0)));
    add(transfers, color_packet(picture(1)));
    EXPECT_THAT(receive(transfers, &statistics), ElementsAre(0, 1)) << "the next picture is whole";
}

TEST(Kinect2Color, NumbersWrapWithoutLoss) {
    Transfers transfers;
    for (const uint32_t n : {0xFFFFFFFEu, 0xFFFFFFFFu, 0u, 2u}) add(transfers, color_packet(picture(n)));
    ColorStatistics statistics;
    EXPECT_THAT(receive(transfers, &statistics), ElementsAre(0xFFFFFFFE, 0xFFFFFFFF, 0, 2));
    EXPECT_EQ(statistics.lost_frames, 1u);
}

}  // namespace
}  // namespace patina::sensor::kinect2::testing::color_assembler_test
