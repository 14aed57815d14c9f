#include "sensor/kinect2/infrared_assembler.h"

#include <cstring>

#include <gmock/gmock.h>

#include "tests/simulated_kinect2/infrared_signal.h"

namespace patina::sensor::kinect2::testing::infrared_assembler_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr uint32_t kFirst = 100;  ///< sequence of frame 0

bool is(const PacketPlace& place, uint32_t frame, uint32_t sub_image, uint32_t packet) {
    return place.frame == frame && place.sub_image == sub_image && place.packet == packet;
}

/// What came out of a faulty stream.
struct Received {
    std::vector<uint32_t> frames;  ///< counted from the start of the stream
    InfraredStatistics statistics;
};

/// Sends frames 0 to `count` - 1. Every frame that comes out must have the bytes that were sent, whatever happened.
Received receive(uint32_t count, InfraredFaults faults, uint32_t first_sequence = kFirst) {
    InfraredSignal signal(patterned_frame, {first_sequence, 5000}, std::move(faults));
    InfraredAssembler assembler;
    InfraredFrame frame;
    Received received;
    while (true) {
        const SentPacket packet = signal.next_interval();
        if (signal.place().frame == count) break;
        if (packet.omitted || !assembler.add(packet.complete, packet.bytes)) continue;
        assembler.take(frame);
        received.frames.push_back(frame.sequence - first_sequence);
        EXPECT_EQ(frame.bytes, *patterned_frame(received.frames.back())) << "frame " << received.frames.back();
        EXPECT_EQ(frame.timestamp, 5000 + begin_of(10ull * received.frames.back()));
    }
    received.statistics = assembler.statistics();
    return received;
}

InfraredFaults on_packet(std::function<void(const PacketPlace&, SentPacket&)> fault) { return {std::move(fault), {}}; }
InfraredFaults on_footer(std::function<void(const PacketPlace&, InfraredFooter&)> fault) {
    return {{}, std::move(fault)};
}

TEST(Kinect2Infrared, NinetyPacketsAreOneFrameByteByByte) {
    InfraredSignal signal(patterned_frame, {7, 4321}, {});
    InfraredAssembler assembler;
    int packets = 0, done_after = 0;
    while (done_after == 0) {
        const SentPacket packet = signal.next_interval();
        ASSERT_EQ(signal.place().frame, 0u);
        packets += packet.bytes.empty() ? 0 : 1;
        if (assembler.add(packet.complete, packet.bytes)) done_after = packets;
    }
    EXPECT_EQ(done_after, 90) << "the frame is complete with its last packet, not with the next frame's first";
    InfraredFrame frame;
    assembler.take(frame);
    EXPECT_EQ(frame.sequence, 7u);
    EXPECT_EQ(frame.timestamp, 4321u);
    EXPECT_EQ(frame.bytes, *patterned_frame(0));
}

TEST(Kinect2Infrared, FaultlessStreamLosesNothing) {
    const Received received = receive(4, {});
    EXPECT_THAT(received.frames, ElementsAre(0, 1, 2, 3));
    EXPECT_EQ(received.statistics.frames, 4u);
    EXPECT_EQ(received.statistics.lost_frames, 0u);
    EXPECT_EQ(received.statistics.lost_packets, 0u);
    EXPECT_EQ(received.statistics.dropped_sub_images, 0u);
}

/// The packets of a frame that tests damage: the first and the last ones, of the first, a middle and the last
/// sub-image.
class Kinect2InfraredPacket : public ::testing::TestWithParam<std::pair<uint32_t, uint32_t>> {
  protected:
    static InfraredFaults at_place(std::function<void(SentPacket&)> fault) {
        return on_packet([place = GetParam(), fault](const PacketPlace& at, SentPacket& packet) {
            if (is(at, 1, place.first, place.second)) fault(packet);
        });
    }
};

TEST_P(Kinect2InfraredPacket, FailedCostsItsFrameAlone) {
    const Received received = receive(4, at_place([](SentPacket& packet) { packet.complete = false; }));
    EXPECT_THAT(received.frames, ElementsAre(0, 2, 3));
    EXPECT_EQ(received.statistics.lost_packets, 1u);
    EXPECT_EQ(received.statistics.lost_frames, 1u);
}

TEST_P(Kinect2InfraredPacket, EmptyCostsItsFrameAlone) {
    EXPECT_THAT(receive(4, at_place([](SentPacket& packet) { packet.bytes = {}; })).frames, ElementsAre(0, 2, 3));
}

TEST_P(Kinect2InfraredPacket, MissingCostsItsFrameAlone) {
    EXPECT_THAT(receive(4, at_place([](SentPacket& packet) { packet.omitted = true; })).frames, ElementsAre(0, 2, 3));
}

TEST_P(Kinect2InfraredPacket, TruncatedCostsItsFrameAlone) {
    for (const size_t cut : {1u, 152u, 5000u, 28000u}) {
        const Received received = receive(
            4, at_place([cut](SentPacket& packet) { packet.bytes = packet.bytes.first(packet.bytes.size() - cut); }));
        EXPECT_THAT(received.frames, ElementsAre(0, 2, 3)) << cut;
    }
}

INSTANTIATE_TEST_SUITE_P(EveryPlace, Kinect2InfraredPacket,
                         ::testing::Values(std::pair(0, 0), std::pair(0, 8), std::pair(4, 3), std::pair(4, 8),
                                           std::pair(9, 0), std::pair(9, 7), std::pair(9, 8)));

TEST(Kinect2Infrared, MissingZeroLengthPacketsCostNothing) {
    const Received received =
        receive(3, on_packet([](const PacketPlace& at, SentPacket& packet) { packet.omitted = at.packet >= 9; }));
    EXPECT_THAT(received.frames, ElementsAre(0, 1, 2));
}

TEST(Kinect2Infrared, FailedPacketWithoutBoundariesBehindItCostsItsFrameAlone) {
    const Received received = receive(4, on_packet([](const PacketPlace& at, SentPacket& packet) {
                                          packet.complete = !is(at, 1, 5, 2);
                                          packet.omitted = at.frame == 1 && at.sub_image == 5 && at.packet >= 9;
                                      }));
    EXPECT_THAT(received.frames, ElementsAre(0, 2, 3));
}

TEST(Kinect2Infrared, DuplicatedSubImageInPlaceOfAnotherCostsItsFrame) {
    const Received received = receive(4, on_footer([](const PacketPlace& at, InfraredFooter& footer) {
                                          if (at.frame == 1 && at.sub_image == 6) footer.sub_image = 3;
                                      }));
    EXPECT_THAT(received.frames, ElementsAre(0, 2, 3));
}

TEST(Kinect2Infrared, ASubImageThatComesTwiceIsTheSame) {
    InfraredSignal signal(patterned_frame, {7, 4321}, {});
    InfraredAssembler assembler;
    std::vector<std::vector<uint8_t>> packets;  // of sub-image 3, which comes once more when it has ended
    uint32_t before = 0;
    bool done = false;
    while (!done) {
        const SentPacket packet = signal.next_interval();
        ASSERT_EQ(signal.place().frame, 0u) << "the frame did not become complete";
        if (signal.place().sub_image == 4 && before == 3) {
            for (const auto& again : packets) EXPECT_FALSE(assembler.add(true, again));
        }
        before = signal.place().sub_image;
        if (before == 3) packets.emplace_back(packet.bytes.begin(), packet.bytes.end());
        done = assembler.add(packet.complete, packet.bytes);
    }
    InfraredFrame frame;
    assembler.take(frame);
    EXPECT_EQ(frame.bytes, *patterned_frame(0));
    EXPECT_EQ(assembler.statistics().frames, 1u);
}

TEST(Kinect2Infrared, SubImagesInAnotherOrderArePutInPlace) {
    // Sent as 1, 0, 2, ..., so that the bytes sent first are those of sub-image 1.
    InfraredSignal::Images swapped = [](uint32_t n) {
        auto frame = std::make_shared<std::vector<uint8_t>>(*patterned_frame(n));
        std::swap_ranges(frame->begin(), frame->begin() + kSubImageBytes, frame->begin() + kSubImageBytes);
        return frame;
    };
    InfraredSignal signal(swapped, {0, 0}, on_footer([](const PacketPlace& at, InfraredFooter& footer) {
                              if (at.sub_image < 2) footer.sub_image = 1 - at.sub_image;
                          }));
    InfraredAssembler assembler;
    InfraredFrame frame;
    for (SentPacket packet = signal.next_interval(); !assembler.add(packet.complete, packet.bytes);) {
        ASSERT_EQ(signal.place().frame, 0u);
        packet = signal.next_interval();
    }
    assembler.take(frame);
    EXPECT_EQ(frame.bytes, *patterned_frame(0));
}

TEST(Kinect2Infrared, FooterWithImpossibleNumbersCostsItsFrame) {
    const auto with = [](std::function<void(InfraredFooter&)> change) {
        return receive(4, on_footer([change](const PacketPlace& at, InfraredFooter& footer) {
                           if (at.frame == 1 && at.sub_image == 6) change(footer);
                       }));
    };
    EXPECT_THAT(with([](InfraredFooter& footer) { footer.sub_image = 10; }).frames, ElementsAre(0, 2, 3));
    EXPECT_THAT(with([](InfraredFooter& footer) { footer.sub_image = 0xFFFFFFFF; }).frames, ElementsAre(0, 2, 3));
    EXPECT_THAT(with([](InfraredFooter& footer) { footer.length -= 4; }).frames, ElementsAre(0, 2, 3));
    EXPECT_THAT(with([](InfraredFooter& footer) { footer.length = 0; }).frames, ElementsAre(0, 2, 3));
}

/// Sequence numbers of a stream whose faults move them; frames are not compared with what was sent.
std::pair<std::vector<uint32_t>, InfraredStatistics> numbers(
    uint32_t count, uint32_t first, std::function<void(const PacketPlace&, InfraredFooter&)> fault) {
    const auto same = patterned_frame(0);
    InfraredSignal signal([&](uint32_t) { return same; }, {first, 0}, on_footer(std::move(fault)));
    InfraredAssembler assembler;
    InfraredFrame frame;
    std::vector<uint32_t> sequences;
    while (true) {
        const SentPacket packet = signal.next_interval();
        if (signal.place().frame == count) return {sequences, assembler.statistics()};
        if (!assembler.add(packet.complete, packet.bytes)) continue;
        assembler.take(frame);
        sequences.push_back(frame.sequence);
    }
}

TEST(Kinect2Infrared, JumpBetweenFramesLosesNoFrameThatArrived) {
    const auto [sequences, statistics] = numbers(4, 0, [](const PacketPlace& at, InfraredFooter& footer) {
        if (at.frame >= 2) footer.sequence += 1000;
    });
    EXPECT_THAT(sequences, ElementsAre(0, 1, 1002, 1003));
    EXPECT_EQ(statistics.lost_frames, 1000u);
}

TEST(Kinect2Infrared, JumpWithinAFrameCostsThatFrame) {
    const auto [sequences, statistics] = numbers(4, 0, [](const PacketPlace& at, InfraredFooter& footer) {
        if (at.frame == 1 && at.sub_image >= 5) footer.sequence += 1000;
    });
    EXPECT_THAT(sequences, ElementsAre(0, 2, 3));
    EXPECT_EQ(statistics.lost_frames, 1u);
}

TEST(Kinect2Infrared, SequenceWrapsWithoutLoss) {
    const auto [sequences, statistics] = numbers(4, 0xFFFFFFFE, {});
    EXPECT_THAT(sequences, ElementsAre(0xFFFFFFFE, 0xFFFFFFFF, 0, 1));
    EXPECT_EQ(statistics.lost_frames, 0u);
}

TEST(Kinect2Infrared, LossAcrossTheWrapIsCounted) {
    const auto [sequences, statistics] = numbers(4, 0xFFFFFFFE, [](const PacketPlace& at, InfraredFooter& footer) {
        if (at.frame == 1 || at.frame == 2) footer.sub_image = 77;
    });
    EXPECT_THAT(sequences, ElementsAre(0xFFFFFFFE, 1));
    EXPECT_EQ(statistics.lost_frames, 2u);
}

TEST(Kinect2Infrared, CounterThatStartsAnewLosesNothing) {
    const auto [sequences, statistics] = numbers(4, 5000, [](const PacketPlace& at, InfraredFooter& footer) {
        if (at.frame >= 2) footer.sequence -= 5002;
    });
    EXPECT_THAT(sequences, ElementsAre(5000, 5001, 0, 1));
    EXPECT_EQ(statistics.lost_frames, 0u);
}

TEST(Kinect2Infrared, RepeatedFrameIsNotReturnedTwice) {
    const auto [sequences, statistics] = numbers(4, 0, [](const PacketPlace& at, InfraredFooter& footer) {
        if (at.frame == 2) footer.sequence = 1;
    });
    EXPECT_THAT(sequences, ElementsAre(0, 1, 3));
    EXPECT_EQ(statistics.lost_frames, 1u);
}

TEST(Kinect2Infrared, StreamThatIsJoinedInTheMiddleStartsWithTheNextFrame) {
    const Received received =
        receive(3, on_packet([](const PacketPlace& at, SentPacket& packet) {
                    packet.omitted = at.frame == 0 && (at.sub_image < 4 || (at.sub_image == 4 && at.packet < 5));
                }));
    EXPECT_THAT(received.frames, ElementsAre(1, 2));
    EXPECT_EQ(received.statistics.lost_frames, 0u) << "what was sent before the first whole frame is not missed";
}

TEST(Kinect2Infrared, RandomLossCostsExactlyTheFramesThatItHits) {
    uint32_t state = 1;
    std::vector<bool> hit(40, false);
    const Received received = receive(40, on_packet([&](const PacketPlace& at, SentPacket& packet) {
                                          state = state * 1664525u + 1013904223u;
                                          if (at.frame >= 40 || at.packet >= 9 || state >> 24 != 0) return;
                                          (state >> 23 & 1 ? packet.complete : packet.omitted) =
                                              state >> 23 & 1 ? false : true;
                                          hit[at.frame] = true;
                                      }));
    std::vector<uint32_t> expected;
    for (uint32_t n = 0; n < 40; ++n) {
        if (!hit[n]) expected.push_back(n);
    }
    EXPECT_EQ(received.frames, expected);
    EXPECT_LT(expected.size(), 36u) << "the test lets packets be lost";
    EXPECT_GT(expected.size(), 4u);
}

TEST(Kinect2Infrared, GarbageIsNoFrame) {
    InfraredAssembler assembler;
    const auto noise = patterned_frame(3);
    uint32_t state = 9;
    for (int i = 0; i < 20000; ++i) {
        state = state * 1664525u + 1013904223u;
        const size_t length = i % 7 == 0 ? 0 : std::min<size_t>(state >> 16, 33792);
        EXPECT_FALSE(assembler.add(i % 11 != 0, std::span(*noise).subspan(state % 1000, length)));
    }
    EXPECT_EQ(assembler.statistics().frames, 0u);
}

}  // namespace
}  // namespace patina::sensor::kinect2::testing::infrared_assembler_test
