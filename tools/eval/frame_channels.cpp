#include "tools/eval/frame_channels.h"

#include <array>

#include "engine/core/error.h"

namespace patina::eval {
namespace {

struct Group {
    const char* name;
    const char* components;  ///< one letter each; empty for a scalar
};

constexpr std::array kGroups = {Group{"kd", "RGB"},         Group{"ks", "RGB"},        Group{"alpha", ""},
                                Group{"kd_segment", "RGB"}, Group{"rgb", "RGB"},       Group{"rgb_segment", "RGB"},
                                Group{"kd_shown", "RGB"},   Group{"rgb_shown", "RGB"}, Group{"depth", ""},
                                Group{"normal", "XYZ"},     Group{"label", ""},        Group{"valid", ""}};

}  // namespace

QuantityChannels channels_for(Quantity quantity) {
    switch (quantity) {
        case Quantity::kKdBefore: return {"kd", "kd_segment", false};
        case Quantity::kKd: return {"kd", "kd", false};
        case Quantity::kKs: return {"ks", "ks", false};
        case Quantity::kAlpha: return {"alpha", "alpha", false};
        case Quantity::kRgbBefore: return {"rgb", "rgb_segment", true};
        case Quantity::kRgb: return {"rgb", "rgb", true};
        case Quantity::kKdShown: return {"kd", "kd_shown", false};
        case Quantity::kRgbShown: return {"rgb", "rgb_shown", true};
    }
    PATINA_ASSERT(false, "quantity ", static_cast<int>(quantity));
}

std::vector<std::string> channel_names(const std::string& group) {
    for (const auto& [name, components] : kGroups) {
        if (group != name) continue;
        std::vector<std::string> names;
        for (const char component : std::string(components)) names.push_back(group + "." + component);
        return names.empty() ? std::vector{group} : names;
    }
    PATINA_ASSERT(false, "group ", group);
}

std::set<std::string> groups_of(const ExrPlanes& frame) {
    std::set<std::string> groups;
    for (const Group& group : kGroups) {
        std::string present, absent;
        for (const std::string& channel : channel_names(group.name)) (frame.has(channel) ? present : absent) = channel;
        if (!present.empty() && !absent.empty()) {
            throw Error(frame.file(), " has a channel ", present, " but no channel ", absent);
        }
        if (absent.empty()) groups.insert(group.name);
    }
    return groups;
}

void expect_groups(const ExrPlanes& frame, const std::set<std::string>& expected, const std::string& first_file) {
    const std::set<std::string> present = groups_of(frame);
    for (const Group& group : kGroups) {
        const std::string channel = channel_names(group.name).front();
        if (expected.contains(group.name) && !present.contains(group.name)) {
            throw Error(frame.file(), " has no channel ", channel, ", but ", first_file, " has one");
        }
        if (!expected.contains(group.name) && present.contains(group.name)) {
            throw Error(frame.file(), " has a channel ", channel, ", but ", first_file, " has none");
        }
    }
}

}  // namespace patina::eval
