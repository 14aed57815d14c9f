#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/core/error.h"
#include "engine/vulkan/resources.h"

namespace patina::graph {

/// Walks over all that outlives frames, in the same order whichever way: to keep it, or to bring it back. What owns
/// such state has a function `visit(StateVisitor&)` that calls one of these for each part of it. Bringing back replaces
/// buffers by others of the size that was kept; so sizes on the host are parts of the state, too. Every name comes
/// once. All throw Error where a part cannot be kept, or what was kept does not fit.
class StateVisitor {
  public:
    virtual ~StateVisitor() = default;

    /// Whether what is visited is replaced by what was kept; else it stays as it is.
    virtual bool brings_back() const = 0;

    /// On the device, by the names that they have there. All the work on them has finished.
    virtual void buffer(vulkan::BufferRef& buffer) = 0;
    virtual void array(vulkan::ChunkedBuffer& array) = 0;
    virtual void image(vulkan::ImageRef& image) = 0;

    /// On the host: bytes, to be kept, or replaced by those that were.
    virtual void bytes(const std::string& name, std::vector<std::byte>& bytes) = 0;

    template <class Value>
    void value(const std::string& name, Value& value) {
        static_assert(std::is_trivially_copyable_v<Value>);
        std::vector<std::byte> held(sizeof(Value));
        std::memcpy(held.data(), &value, sizeof(Value));
        bytes(name, held);
        if (held.size() != sizeof(Value)) throw Error("'", name, "' has ", held.size(), " bytes, not ", sizeof(Value));
        std::memcpy(static_cast<void*>(&value), held.data(), sizeof(Value));
    }

    template <class Value>
    void values(const std::string& name, std::vector<Value>& values) {
        static_assert(std::is_trivially_copyable_v<Value>);
        std::vector<std::byte> held(values.size() * sizeof(Value));
        if (!held.empty()) std::memcpy(held.data(), values.data(), held.size());
        bytes(name, held);
        if (held.size() % sizeof(Value) != 0)
            throw Error("'", name, "' has ", held.size(), " bytes, no multiple of ", sizeof(Value));
        values.resize(held.size() / sizeof(Value));
        if (!held.empty()) std::memcpy(values.data(), held.data(), held.size());
    }

    void text(const std::string& name, std::string& text) {
        std::vector<char> characters(text.begin(), text.end());
        values(name, characters);
        text.assign(characters.begin(), characters.end());
    }

    /// `texts` may hold any characters but zero.
    void texts(const std::string& name, std::vector<std::string>& texts) {
        std::vector<char> joined;
        for (const std::string& text : texts) joined.insert(joined.end(), text.c_str(), text.c_str() + text.size() + 1);
        values(name, joined);
        texts.clear();
        for (auto at = joined.begin(); at != joined.end();) {
            const auto end = std::find(at, joined.end(), '\0');
            if (end == joined.end()) throw Error("'", name, "' ends within a text");
            texts.emplace_back(at, end);
            at = end + 1;
        }
    }
};

}  // namespace patina::graph
