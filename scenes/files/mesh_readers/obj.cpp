#include "scenes/files/mesh_readers/obj.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "scenes/files/mesh_readers/mesh_builder.h"

namespace patina::scenes {
namespace {

constexpr std::string_view kSpaces = " \t\r\v\f";

/// The words of a line, one after the other.
class Words {
  public:
    explicit Words(std::string_view line) : rest_(line) {}

    /// Empty after the last one.
    std::string_view next() {
        const size_t begin = rest_.find_first_not_of(kSpaces);
        rest_.remove_prefix(std::min(begin, rest_.size()));
        const std::string_view word = rest_.substr(0, rest_.find_first_of(kSpaces));
        rest_.remove_prefix(word.size());
        return word;
    }

  private:
    std::string_view rest_;
};

class ObjReader {
  public:
    explicit ObjReader(std::span<const uint8_t> bytes)
        : rest_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}

    TriangleMesh read() {
        while (!rest_.empty()) {
            const std::string_view line = next_line();
            Words words(line.substr(0, line.find('#')));
            const std::string_view keyword = words.next();
            if (keyword == "v") add(positions_, vector(words, 3));
            if (keyword == "vn") add(normals_, vector(words, 3));
            if (keyword == "vt") add(uvs_, vector(words, 1));
            if (keyword == "f") read_face(words);
        }
        return std::move(builder_).finish();
    }

  private:
    /// A line, with those that a backslash at its end continues it by.
    std::string_view next_line() {
        size_t end = 0;
        do {
            end = std::min(rest_.find('\n', end), rest_.size() - 1) + 1;
            ++number_;
        } while (end < rest_.size() && rest_.front() != '#' && continues(rest_.substr(0, end)));
        const std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end);
        if (line.find('\\') == std::string_view::npos) return line.substr(0, line.find('\n'));
        joined_ = line;
        std::ranges::replace_if(
            joined_, [](char c) { return c == '\\' || c == '\n'; }, ' ');
        return joined_;
    }

    static bool continues(std::string_view line) {
        line.remove_suffix(1);
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line.ends_with('\\');
    }

    [[noreturn]] void fail(std::string_view word, const char* must_be) const {
        constexpr size_t kLongest = 40;
        throw Error("line ", number_, ": '", word.substr(0, kLongest), "' is no ", must_be);
    }

    template <class Number>
    bool parse(std::string_view digits, Number& value) const {
        if (digits.starts_with('+')) digits.remove_prefix(1);  // from_chars takes no plus sign
        const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        return failure == std::errc{} && end == digits.data() + digits.size();
    }

    /// Up to three numbers, at least `least`; those that are left out are 0. More, as colours, are passed over.
    glm::dvec3 vector(Words& words, int least) const {
        glm::dvec3 v(0);
        for (int i = 0; i < 3; ++i) {
            const std::string_view word = words.next();
            if (word.empty() && i < least)
                throw Error("line ", number_, ": it has ", i, " numbers, must have at least ", least);
            if (word.empty()) break;
            if (!parse(word, v[i])) fail(word, "number");
        }
        return v;
    }

    template <class Element>
    void add(std::vector<Element>& list, glm::dvec3 v) const {
        constexpr uint64_t kMost = 3 * limits::kTriangles;  // as where no two triangles share any
        if (list.size() == kMost)
            throw Error("line ", number_, ": it has more than ", kMost, " v, vn or vt, the most that are read");
        list.emplace_back(v);
    }

    /// The element that the first of the indices in `word`, as "7/-2/5", stands for, which is taken off; none where
    /// it is left out.
    template <class Element>
    const Element* element(std::string_view& word, const std::vector<Element>& list, const char* name) const {
        const std::string_view digits = word.substr(0, word.find('/'));
        word.remove_prefix(std::min(digits.size() + 1, word.size()));
        if (digits.empty()) return nullptr;
        int64_t index = 0;
        if (!parse(digits, index)) fail(digits, "index");
        const auto count = static_cast<int64_t>(list.size());
        if (index == 0 || index > count || index < -count)
            throw Error("line ", number_, ": a corner's ", name, " is ", index, ", but there are ", count);
        return &list[static_cast<size_t>(index > 0 ? index - 1 : count + index)];
    }

    void read_face(Words& words) {
        corners_.clear();
        for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
            if (corners_.size() == kMostFaceCorners)
                throw Error("line ", number_, ": a face has more than ", kMostFaceCorners,
                            " corners, the most that are read");
            MeshCorner& corner = corners_.emplace_back();
            const std::string_view whole = word;
            const glm::vec3* position = element(word, positions_, "v");
            if (!position) fail(whole, "corner");
            corner.position = *position;
            // A picture's bottom left is (0, 0) in the file.
            if (const glm::vec2* uv = element(word, uvs_, "vt")) corner.uv = {uv->x, 1 - double(uv->y)};
            if (const glm::vec3* normal = element(word, normals_, "vn")) corner.normal = *normal;
        }
        if (corners_.size() < 3) return;  // a line or a point, which other programs write so
        try {
            builder_.add_face(corners_);
        } catch (const Error& error) {
            throw Error("line ", number_, ": ", error.what());
        }
    }

    std::string_view rest_;
    size_t number_ = 0;   ///< of the latest line, from 1
    std::string joined_;  ///< a line that was continued
    std::vector<glm::vec3> positions_, normals_;
    std::vector<glm::vec2> uvs_;
    std::vector<MeshCorner> corners_;
    MeshBuilder builder_;
};

}  // namespace

TriangleMesh read_obj(std::span<const uint8_t> bytes) { return ObjReader(bytes).read(); }

}  // namespace patina::scenes
