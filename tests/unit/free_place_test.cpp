#include "tools/program/free_place.h"

#include <gmock/gmock.h>

#include "engine/core/error.h"

namespace patina::tools::free_place_test {
namespace {

using ::testing::HasSubstr;

TEST(FreePlace, IsBesideWithTheFirstFreeNumber) {
    EXPECT_EQ(free_place_beside("/nowhere/room.d/", "export"), "/nowhere/room-export-1");
    EXPECT_EQ(free_place_beside("/nowhere/room", "recording", ".patina"), "/nowhere/room-recording-1.patina");
}

TEST(FreePlace, WhatTheSystemDoesNotSayIsAnError) {
    try {
        free_place_beside("/tmp/" + std::string(300, 'x'), "export");
        FAIL() << "a name of 300 characters was looked up";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("cannot be looked for: File name too long"));
    }
}

}  // namespace
}  // namespace patina::tools::free_place_test
