#include "reconstruction/store/map_file.h"

#include <atomic>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>

#include "engine/core/error.h"
#include "tests/export/temporary_folder.h"

namespace patina::map_file_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::vector<std::byte> bytes_of(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

/// Bytes that do not compress.
std::vector<std::byte> noise(size_t count) {
    std::vector<std::byte> bytes(count);
    uint32_t state = 1;
    for (std::byte& byte : bytes) byte = static_cast<std::byte>((state = state * 1664525 + 1013904223) >> 24);
    return bytes;
}

class MapFileTest : public ::testing::Test {
  protected:
    const test::TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_ / "map.sqlite";
};

TEST_F(MapFileTest, HoldsTextsArraysAndFiles) {
    const std::vector<std::byte> piece = noise(1000);
    {
        MapFile map(file_);
        Transaction change(map.database());
        map.set_text("device", "one");
        map.set_text("device", "two");
        map.set_bytes("map.tsdf", MapFile::kPieceBytes + piece.size());
        map.set_piece("map.tsdf", 0, std::vector<std::byte>(MapFile::kPieceBytes));
        map.set_piece("map.tsdf", 1, piece);
        map.set_file("previews/1.png", std::string("a\0b", 3));
        change.commit();
    }
    MapFile map(file_);
    EXPECT_EQ(map.text("device"), "two");
    EXPECT_EQ(map.text("other"), std::nullopt);
    EXPECT_EQ(map.bytes("map.tsdf"), MapFile::kPieceBytes + piece.size());
    EXPECT_EQ(map.piece("map.tsdf", 0), std::vector<std::byte>(MapFile::kPieceBytes));
    EXPECT_EQ(map.piece("map.tsdf", 1), piece);
    EXPECT_THAT(map.files(), ElementsAre("previews/1.png"));
    EXPECT_EQ(map.content_of_file("previews/1.png"), std::string("a\0b", 3));
    EXPECT_EQ(map.size().arrays, 1u);
    EXPECT_EQ(map.size().bytes, MapFile::kPieceBytes + piece.size());
    EXPECT_LT(map.size().compressed_bytes, 2000u);
    map.check();
}

TEST_F(MapFileTest, NamesWhatItLacks) {
    MapFile map(file_);
    map.set_bytes("map.tsdf", 10);
    EXPECT_THAT([&] { map.bytes("map.color"); }, ThrowsMessage<Error>(HasSubstr("has no array 'map.color'")));
    EXPECT_THAT([&] { map.piece("map.tsdf", 0); },
                ThrowsMessage<Error>(AllOf(HasSubstr("map.sqlite"), HasSubstr("piece 0 of 'map.tsdf' is missing"))));
    EXPECT_THAT([&] { map.expect_text("device"); }, ThrowsMessage<Error>(HasSubstr("has no text 'device'")));
    EXPECT_THAT([&] { map.check(); }, ThrowsMessage<Error>(HasSubstr("is missing")));
    EXPECT_THAT([&] { MapFile::with_state(folder_ / "other"); }, ThrowsMessage<Error>(HasSubstr("there is no map")));
    EXPECT_THAT([&] { MapFile::with_state(file_); }, ThrowsMessage<Error>(HasSubstr("holds no state yet")));
    map.set_text("progress", "{");
    EXPECT_THAT([&] { map.expect_json("progress"); },
                ThrowsMessage<Error>(HasSubstr("the text 'progress' is no JSON")));
    map.set_text("progress", "{}");
    EXPECT_TRUE(map.expect_json("progress").empty());
    EXPECT_EQ(MapFile::with_state(file_)->text("progress"), "{}");
}

TEST_F(MapFileTest, AnArrayThatShrinksLosesItsPieces) {
    MapFile map(file_);
    map.set_bytes("a", 2 * MapFile::kPieceBytes);
    map.set_piece("a", 0, std::vector<std::byte>(MapFile::kPieceBytes));
    map.set_piece("a", 1, std::vector<std::byte>(MapFile::kPieceBytes));
    map.set_bytes("a", MapFile::kPieceBytes);
    EXPECT_EQ(map.size().pieces, 1u);
    map.check();
}

TEST_F(MapFileTest, WritesOnlyPiecesThatChanged) {
    MapFile map(file_);
    const auto changes = [&] {
        Query query(map.database(), "SELECT total_changes()");
        query.next();
        return query.number(0);
    };
    map.set_piece("a", 0, bytes_of("one"));
    map.set_piece("a", 1, bytes_of("two"));
    const int64_t before = changes();
    map.set_piece("a", 0, bytes_of("one"));
    EXPECT_EQ(changes(), before);
    map.set_piece("a", 1, bytes_of("other"));
    EXPECT_GT(changes(), before);
    EXPECT_EQ(map.piece("a", 1), bytes_of("other"));
}

TEST_F(MapFileTest, ChangesAreMadeTogetherOrNotAtAll) {
    MapFile map(file_);
    {
        Transaction change(map.database());
        map.set_text("a", "before");
        change.commit();
    }
    {
        Transaction change(map.database());
        map.clear();
        map.set_text("a", "after");
    }
    EXPECT_EQ(map.text("a"), "before");
}

TEST_F(MapFileTest, FindsDamage) {
    {
        MapFile map(file_);
        map.set_bytes("a", 100000);
        map.set_piece("a", 0, noise(100000));
    }
    // In the middle of the blob, beyond all that SQLite looks at itself.
    std::fstream file(file_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(file_) / 2));
    file.write("damage", 6);
    file.close();
    MapFile map(file_);
    EXPECT_THAT([&] { map.piece("a", 0); }, ThrowsMessage<Error>(HasSubstr("piece 0 of 'a' is damaged")));
}

TEST_F(MapFileTest, RefusesWhatIsNoMap) {
    std::ofstream(file_) << std::string(5000, 'x');
    EXPECT_THAT([&] { MapFile map(file_); },
                ThrowsMessage<Error>(AllOf(HasSubstr("map.sqlite"), HasSubstr("it is no SQLite database"))));
    const std::filesystem::path other = folder_ / "other.sqlite";
    Database(other).run("CREATE TABLE t (x)");
    EXPECT_THAT([&] { MapFile map(other); }, ThrowsMessage<Error>(HasSubstr("is no map of Patina's")));
    const std::filesystem::path newer = folder_ / "newer.sqlite";
    MapFile(newer).database().run("PRAGMA user_version = 99");
    EXPECT_THAT([&] { MapFile map(newer); },
                ThrowsMessage<Error>(HasSubstr("schema 99, this program reads " + std::to_string(MapFile::kSchema))));
    EXPECT_THAT([&] { MapFile map(folder_ / "missing" / "map.sqlite"); },
                ThrowsMessage<Error>(HasSubstr("it cannot be opened")));
}

TEST_F(MapFileTest, OneWriterAtATime) {
    MapFile map(file_), other(file_);
    other.database().run("PRAGMA busy_timeout = 0");
    const Transaction change(map.database());
    EXPECT_THAT([&] { const Transaction second(other.database()); },
                ThrowsMessage<Error>(HasSubstr("another process is writing to it")));
}

TEST_F(MapFileTest, AWriterWaitsForWhoReads) {
    MapFile map(file_);
    map.set_text("a", "before");
    std::atomic<bool> is_read = false;
    std::jthread reader([&] {
        MapFile other(file_);
        Query query(other.database(), "SELECT text FROM texts");
        query.next();
        is_read = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
    });
    while (!is_read) std::this_thread::yield();
    map.set_text("a", "after");
    EXPECT_EQ(map.text("a"), "after");
}

TEST_F(MapFileTest, AFullDiskChangesNothing) {
    MapFile map(file_);
    map.set_text("a", "before");
    map.database().run("PRAGMA max_page_count = 8");
    EXPECT_THAT(
        [&] {
            const Transaction change(map.database());
            map.set_text("a", "after");
            map.set_piece("a", 0, noise(100000));
        },
        ThrowsMessage<Error>(HasSubstr("no space is left on the disk")));
    EXPECT_EQ(map.text("a"), "before");
}

}  // namespace
}  // namespace patina::map_file_test
