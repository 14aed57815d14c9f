#include "reconstruction/session/tensor_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "sensor/files/json_file.h"

namespace patina {

namespace {

using sensor::JsonValue;

static_assert(std::endian::native == std::endian::little, "the file's numbers are little-endian");

/// A tensor's bytes, from the header's end.
struct Range {
    std::string name;
    uint64_t begin = 0;
    uint64_t end = 0;
};

std::span<const uint8_t> header_of(const std::string& file, std::span<const uint8_t> bytes) {
    uint64_t length = 0;
    if (bytes.size() < sizeof(length)) {
        throw Error(file, ": the header's length takes ", sizeof(length), " bytes, the file has ", bytes.size());
    }
    std::memcpy(&length, bytes.data(), sizeof(length));
    if (length > limits::kHeaderBytes) {
        throw Error(file, ": the header's length is ", length, " bytes, at most ", limits::kHeaderBytes, " are read");
    }
    if (length > bytes.size() - sizeof(length)) {
        throw Error(file, ": the header's length is ", length, " bytes, the file has ", bytes.size() - sizeof(length),
                    " behind it");
    }
    return bytes.subspan(sizeof(length), length);
}

Range range_of(const std::string& name, const JsonValue& tensor, uint64_t data_bytes) {
    const std::vector<JsonValue> offsets = tensor.at("data_offsets").elements_of(2);
    Range range{name, offsets[0].whole_number(data_bytes), offsets[1].whole_number(data_bytes)};
    if (range.begin > range.end) tensor.at("data_offsets").fail("must not end before it begins");
    return range;
}

std::vector<uint64_t> shape_of(const JsonValue& tensor, const Range& range) {
    std::vector<uint64_t> shape;
    uint64_t bytes = sizeof(float);
    for (const JsonValue& extent : tensor.at("shape").elements()) {
        shape.push_back(extent.whole_number(UINT32_MAX));
        bytes = bytes > UINT32_MAX ? bytes : bytes * shape.back();  // a product so large is wrong anyway
    }
    if (bytes != range.end - range.begin) {
        tensor.at("shape").fail(
            text("takes ", bytes, " bytes, its data_offsets are ", range.end - range.begin, " apart"));
    }
    return shape;
}

Tensor read_tensor(const JsonValue& tensor, const Range& range, std::span<const uint8_t> data) {
    tensor.expect_keys({"dtype", "shape", "data_offsets"});
    if (tensor.at("dtype").string() != "F32") tensor.at("dtype").fail("must be \"F32\"");
    Tensor result{shape_of(tensor, range), std::vector<float>((range.end - range.begin) / sizeof(float))};
    std::memcpy(result.values.data(), data.data() + range.begin, range.end - range.begin);
    for (size_t i = 0; i < result.values.size(); ++i) {
        if (std::isfinite(result.values[i])) continue;
        throw Error(tensor.where(), ": element ", i, " is ", result.values[i], ", must be finite");
    }
    return result;
}

void check_side_by_side(const std::string& file, std::vector<Range> ranges, uint64_t data_bytes) {
    const auto key = [](const Range& range) { return std::pair(range.begin, range.end); };
    std::ranges::sort(ranges, {}, key);
    Range before{"the header", 0, 0};
    for (const Range& range : ranges) {
        if (range.begin != before.end) {
            throw Error(file, ": ", range.name, ".data_offsets begin at ", range.begin, ", ", before.name, " ends at ",
                        before.end, range.begin < before.end ? ": they overlap" : ": there is a gap");
        }
        before = range;
    }
    if (before.end != data_bytes) {
        throw Error(file, ": the tensors end at ", before.end, " bytes, the file's data at ", data_bytes);
    }
}

}  // namespace

TensorFile read_tensor_file(const std::filesystem::path& file) {
    TensorFile result{file.string(), {}, {}};
    const std::vector<uint8_t> bytes = read_file(file, limits::kNetworkBytes);
    const std::span<const uint8_t> header_bytes = header_of(result.file, bytes);
    const std::span<const uint8_t> data = std::span(bytes).subspan(sizeof(uint64_t) + header_bytes.size());
    const JsonValue header = JsonValue::parse(result.file, header_bytes);
    std::vector<Range> ranges;
    for (const auto& [name, value] : header.members()) {
        if (name == "__metadata__") {
            for (const auto& [key, member] : value.members()) result.metadata[key] = member.string();
            continue;
        }
        ranges.push_back(range_of(name, value, data.size()));
        result.tensors[name] = read_tensor(value, ranges.back(), data);
    }
    check_side_by_side(result.file, std::move(ranges), data.size());
    return result;
}

std::string text_of_shape(const std::vector<uint64_t>& shape) {
    std::string list;
    for (const uint64_t extent : shape) list += (list.empty() ? "" : ", ") + std::to_string(extent);
    return "[" + list + "]";
}

}  // namespace patina
