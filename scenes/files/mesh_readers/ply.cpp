#include "scenes/files/mesh_readers/ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "scenes/files/mesh_readers/mesh_builder.h"

namespace patina::scenes {
namespace {

enum class Encoding { kAscii, kLittleEndian, kBigEndian };

struct Type {
    enum Kind { kSigned, kUnsigned, kFloat } kind;
    size_t bytes;
};

struct Property {
    std::string name;
    Type type;
    std::optional<Type> count{};  ///< of a list's length
};

struct Element {
    std::string name;
    uint64_t count = 0;
    std::vector<Property> properties{};
};

struct Header {
    Encoding encoding = Encoding::kAscii;
    std::vector<Element> elements{};
    size_t bytes = 0;
};

std::vector<std::string> words_of(std::string_view line) {
    std::vector<std::string> words;
    constexpr std::string_view kBlanks = " \t\r";
    for (size_t begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
        const size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
        words.emplace_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(kBlanks, end);
    }
    return words;
}

Type type_named(const std::string& name) {
    static const std::map<std::string, Type> kTypes{
        {"char", {Type::kSigned, 1}},     {"int8", {Type::kSigned, 1}},     {"uchar", {Type::kUnsigned, 1}},
        {"uint8", {Type::kUnsigned, 1}},  {"short", {Type::kSigned, 2}},    {"int16", {Type::kSigned, 2}},
        {"ushort", {Type::kUnsigned, 2}}, {"uint16", {Type::kUnsigned, 2}}, {"int", {Type::kSigned, 4}},
        {"int32", {Type::kSigned, 4}},    {"uint", {Type::kUnsigned, 4}},   {"uint32", {Type::kUnsigned, 4}},
        {"float", {Type::kFloat, 4}},     {"float32", {Type::kFloat, 4}},   {"double", {Type::kFloat, 8}},
        {"float64", {Type::kFloat, 8}},
    };
    const auto found = kTypes.find(name);
    if (found == kTypes.end()) throw Error("its header has a property of type '", name, "', which PLY does not know");
    return found->second;
}

/// Reads the header line by line.
class HeaderReader {
  public:
    explicit HeaderReader(std::span<const uint8_t> bytes)
        : text_(reinterpret_cast<const char*>(bytes.data()), std::min<size_t>(bytes.size(), limits::kHeaderBytes)) {}

    Header read() {
        if (next_line() != std::vector<std::string>{"ply"}) throw Error("it does not begin with 'ply'");
        bool has_format = false;
        for (std::vector<std::string> words = next_line(); words != std::vector<std::string>{"end_header"};
             words = next_line()) {
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
            if (words[0] == "format") {
                read_format(words);
                has_format = true;
            } else if (words[0] == "element") {
                read_element(words);
            } else if (words[0] == "property") {
                read_property(words);
            } else {
                fail("a keyword of PLY");
            }
        }
        if (!has_format) throw Error("its header names no format");
        header_.bytes = position_;
        return std::move(header_);
    }

  private:
    std::vector<std::string> next_line() {
        const size_t end = text_.find('\n', position_);
        if (end == std::string_view::npos) {
            throw Error("its header has no end_header within its first ", text_.size(), " bytes, at most ",
                        limits::kHeaderBytes, " are read");
        }
        line_ = text_.substr(position_, end - position_);
        position_ = end + 1;
        ++number_;
        return words_of(line_);
    }

    [[noreturn]] void fail(const char* must_be) const {
        constexpr size_t kLongest = 80;
        throw Error("line ", number_, " of its header is '", line_.substr(0, kLongest), "', must be ", must_be);
    }

    void read_format(const std::vector<std::string>& words) {
        static const std::map<std::string, Encoding> kEncodings{{"ascii", Encoding::kAscii},
                                                                {"binary_little_endian", Encoding::kLittleEndian},
                                                                {"binary_big_endian", Encoding::kBigEndian}};
        if (words.size() != 3 || !kEncodings.contains(words[1]) || words[2] != "1.0")
            fail("'format', one of ascii, binary_little_endian and binary_big_endian, and 1.0");
        header_.encoding = kEncodings.at(words[1]);
    }

    void read_element(const std::vector<std::string>& words) {
        if (words.size() != 3) fail("'element', a name and a count");
        Element element{words[1]};
        const std::string& count = words[2];
        const auto [end, failure] = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (failure != std::errc{} || end != count.data() + count.size()) fail("'element', a name and a count");
        header_.elements.push_back(std::move(element));
    }

    void read_property(const std::vector<std::string>& words) {
        if (header_.elements.empty()) fail("behind an element");
        Property property;
        if (words.size() == 3) {
            property = {words[2], type_named(words[1])};
        } else if (words.size() == 5 && words[1] == "list") {
            property = {words[4], type_named(words[3]), type_named(words[2])};
            if (property.count->kind == Type::kFloat) fail("a list whose length is an integer");
        } else {
            fail("'property', a type and a name, or 'property list', two types and a name");
        }
        header_.elements.back().properties.push_back(std::move(property));
    }

    std::string_view text_;
    std::string_view line_;
    size_t position_ = 0;
    size_t number_ = 0;
    Header header_;
};

/// The numbers behind the header, one after the other.
class Body {
  public:
    Body(Encoding encoding, std::span<const uint8_t> bytes) : encoding_(encoding), bytes_(bytes) {}

    double number(Type type) { return encoding_ == Encoding::kAscii ? parsed<double>() : decoded(type); }

    /// A list's length or an index. A double holds every integer of PLY.
    int64_t integer(Type type) {
        return encoding_ == Encoding::kAscii ? parsed<int64_t>() : static_cast<int64_t>(decoded(type));
    }

    void skip(Type type) {
        if (encoding_ == Encoding::kAscii) {
            word();
        } else {
            take(type.bytes);
        }
    }

    uint64_t list_length(const Property& property) {
        const int64_t length = integer(*property.count);
        if (length < 0) throw Error("a list ", property.name, " has a length of ", length);
        expect_room(text("a list ", property.name), static_cast<uint64_t>(length), least_bytes(property.type));
        return static_cast<uint64_t>(length);
    }

    /// Throws Error unless `count` times `bytes` can still follow.
    void expect_room(const std::string& what, uint64_t count, uint64_t bytes) const {
        // The last word of a text needs no space behind it.
        const uint64_t left = bytes_.size() - position_ + (encoding_ == Encoding::kAscii ? 1 : 0);
        if (count <= left / bytes) return;
        throw Error("it is truncated: ", what, " of ", count, " takes at least ", bytes, " bytes for each, but ",
                    bytes_.size() - position_, " are left");
    }

    /// The least that an entry with these properties takes.
    uint64_t least_bytes(const Element& element) const {
        uint64_t sum = 0;
        for (const Property& property : element.properties) sum += least_bytes(property.count.value_or(property.type));
        return sum;
    }

  private:
    uint64_t least_bytes(Type type) const { return encoding_ == Encoding::kAscii ? 2 : type.bytes; }

    std::span<const uint8_t> take(size_t count) {
        if (count > bytes_.size() - position_) {
            throw Error("it is truncated: behind its header it has ", bytes_.size(), " bytes, but byte ",
                        position_ + count, " is needed");
        }
        position_ += count;
        return bytes_.subspan(position_ - count, count);
    }

    std::string_view word() {
        const auto is_space = [](uint8_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
        while (position_ < bytes_.size() && is_space(bytes_[position_])) ++position_;
        const size_t begin = position_;
        while (position_ < bytes_.size() && !is_space(bytes_[position_])) ++position_;
        if (begin == position_) throw Error("it is truncated: it ends where a number is due");
        return {reinterpret_cast<const char*>(bytes_.data()) + begin, position_ - begin};
    }

    template <class Number>
    Number parsed() {
        const std::string_view digits = word();
        Number value = 0;
        const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (failure == std::errc{} && end == digits.data() + digits.size()) return value;
        constexpr size_t kLongest = 40;
        throw Error("'", digits.substr(0, kLongest), "' at byte ", position_ - digits.size(),
                    " behind its header is no ", std::is_integral_v<Number> ? "whole number" : "number");
    }

    template <class Number>
    double cast(std::array<uint8_t, 8> raw) {
        Number number;
        std::memcpy(&number, raw.data(), sizeof(number));
        return static_cast<double>(number);
    }

    double decoded(Type type) {
        std::array<uint8_t, 8> raw{};
        std::ranges::copy(take(type.bytes), raw.begin());
        static_assert(std::endian::native == std::endian::little);
        if (encoding_ == Encoding::kBigEndian) std::reverse(raw.begin(), raw.begin() + std::ptrdiff_t(type.bytes));
        if (type.kind == Type::kFloat) return type.bytes == 4 ? cast<float>(raw) : cast<double>(raw);
        const bool is_signed = type.kind == Type::kSigned;
        switch (type.bytes) {
            case 1: return is_signed ? cast<int8_t>(raw) : cast<uint8_t>(raw);
            case 2: return is_signed ? cast<int16_t>(raw) : cast<uint16_t>(raw);
            default: return is_signed ? cast<int32_t>(raw) : cast<uint32_t>(raw);
        }
    }

    Encoding encoding_;
    std::span<const uint8_t> bytes_;
    size_t position_ = 0;
};

/// Takes the vertices and faces from the body.
class PlyReader {
  public:
    PlyReader(const Header& header, std::span<const uint8_t> bytes)
        : header_(header), body_(header.encoding, bytes.subspan(header.bytes)) {}

    TriangleMesh read() {
        for (const Element& element : header_.elements) read(element);
        if (!has_faces_) throw Error("it has no element face, and only a mesh's faces are read");
        return std::move(builder_).finish();
    }

  private:
    void read(const Element& element) {
        if (element.count > 0 && element.properties.empty())
            throw Error("its header has ", element.count, " of element ", element.name, ", but no property of it");
        if (element.count > limits::kTriangles) {
            throw Error("its header has ", element.count, " of element ", element.name, ", at most ",
                        limits::kTriangles, " are read");
        }
        if (element.count > 0) body_.expect_room("element " + element.name, element.count, body_.least_bytes(element));
        if (element.name == "vertex") {
            read_vertices(element);
        } else if (element.name == "face") {
            read_faces(element);
        } else {
            for (uint64_t i = 0; i < element.count; ++i) {
                for (const Property& property : element.properties) skip(property);
            }
        }
    }

    void skip(const Property& property) {
        const uint64_t count = property.count ? body_.list_length(property) : 1;
        for (uint64_t i = 0; i < count; ++i) body_.skip(property.type);
    }

    /// Which of a vertex's numbers a property is; empty for those that are not used.
    static std::optional<size_t> place_of(const Property& property) {
        static const std::map<std::string, size_t> kPlaces{
            {"x", 0}, {"y", 1}, {"z", 2},         {"nx", 3}, {"ny", 4}, {"nz", 5},
            {"u", 6}, {"s", 6}, {"texture_u", 6}, {"v", 7},  {"t", 7},  {"texture_v", 7},
        };
        const auto found = kPlaces.find(property.name);
        return property.count || found == kPlaces.end() ? std::nullopt : std::optional(found->second);
    }

    void read_vertices(const Element& element) {
        if (has_vertices_) throw Error("its header has two elements vertex");
        has_vertices_ = true;
        std::vector<std::optional<size_t>> places;
        std::array<bool, 8> has{};
        for (const Property& property : element.properties) {
            places.push_back(place_of(property));
            if (!places.back()) continue;
            if (has[*places.back()]) throw Error("its vertices have ", property.name, " a second time");
            has[*places.back()] = true;
        }
        if (!(has[0] && has[1] && has[2])) throw Error("its vertices have no x, y and z");
        has_normals_ = has[3] && has[4] && has[5];
        has_uvs_ = has[6] && has[7];
        vertices_.reserve(element.count);
        for (uint64_t i = 0; i < element.count; ++i) {
            std::array<float, 8>& vertex = vertices_.emplace_back();
            for (size_t p = 0; p < places.size(); ++p) {
                if (places[p]) {
                    vertex[*places[p]] = static_cast<float>(body_.number(element.properties[p].type));
                } else {
                    skip(element.properties[p]);
                }
            }
        }
    }

    void read_faces(const Element& element) {
        if (has_faces_ || !has_vertices_)
            throw Error("its header has ", has_faces_ ? "two elements face" : "no element vertex before its faces");
        has_faces_ = true;
        const auto is_indices = [](const Property& p) {
            return p.count && p.type.kind != Type::kFloat && (p.name == "vertex_indices" || p.name == "vertex_index");
        };
        const auto is_uvs = [](const Property& p) { return p.count && p.name == "texcoord"; };
        if (std::ranges::count_if(element.properties, is_indices) != 1)
            throw Error("its faces have no list vertex_indices of whole numbers, or more than one");
        for (uint64_t face = 0; face < element.count; ++face) {
            for (const Property& property : element.properties) {
                if (is_indices(property)) {
                    read_list(property, kMostFaceCorners, indices_, [&] { return body_.integer(property.type); });
                } else if (is_uvs(property)) {
                    read_list(property, 2 * kMostFaceCorners, uvs_, [&] { return body_.number(property.type); });
                } else {
                    skip(property);
                }
            }
            add_face(face);
        }
    }

    template <class Number, class Read>
    void read_list(const Property& property, size_t most, std::vector<Number>& list, Read read) {
        const uint64_t length = body_.list_length(property);
        if (length > most) throw Error("a face has ", length, " ", property.name, ", at most ", most, " are read");
        list.resize(length);
        for (Number& number : list) number = read();
    }

    void add_face(uint64_t face) {
        corners_.clear();
        for (size_t i = 0; i < indices_.size(); ++i) {
            if (indices_[i] < 0 || static_cast<uint64_t>(indices_[i]) >= vertices_.size()) {
                throw Error("face ", face, " has a corner at vertex ", indices_[i], ", but there are ",
                            vertices_.size());
            }
            const std::array<float, 8>& v = vertices_[static_cast<size_t>(indices_[i])];
            MeshCorner& corner = corners_.emplace_back(MeshCorner{{v[0], v[1], v[2]}});
            if (has_normals_) corner.normal = {v[3], v[4], v[5]};
            // A picture's bottom left is (0, 0) in the file.
            if (uvs_.size() == 2 * indices_.size()) {
                corner.uv = {uvs_[2 * i], 1 - uvs_[2 * i + 1]};
            } else if (has_uvs_) {
                corner.uv = {v[6], 1 - double(v[7])};
            }
        }
        if (corners_.size() >= 3) builder_.add_face(corners_);
    }

    const Header& header_;
    Body body_;
    MeshBuilder builder_;
    bool has_vertices_ = false, has_faces_ = false, has_normals_ = false, has_uvs_ = false;
    std::vector<std::array<float, 8>> vertices_;  ///< x y z, normal, u v
    // Of the face that is read:
    std::vector<int64_t> indices_;
    std::vector<double> uvs_;
    std::vector<MeshCorner> corners_;
};

}  // namespace

TriangleMesh read_ply(std::span<const uint8_t> bytes) {
    const Header header = HeaderReader(bytes).read();
    return PlyReader(header, bytes).read();
}

}  // namespace patina::scenes
