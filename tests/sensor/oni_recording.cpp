#include "tests/sensor/oni_recording.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace patina::sensor::testing {

namespace {

template <class Value>
void put(std::string& bytes, const Value& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(Value));
}

std::string named(const std::string& name) {
    std::string bytes;
    put(bytes, static_cast<uint32_t>(name.size() + 1));
    return bytes + name + '\0';
}

void put_record(std::string& file, uint32_t type, uint32_t node, const std::string& fields,
                const std::vector<uint8_t>& payload = {}) {
    file += std::string("NIR\0", 4);
    put(file, type);
    put(file, node);
    put(file, static_cast<uint32_t>(28 + fields.size()));
    put(file, static_cast<uint32_t>(payload.size()));
    put(file, uint64_t{0});
    file += fields;
    file.append(payload.begin(), payload.end());
}

void put_int(std::string& file, uint32_t node, const std::string& name, uint64_t value) {
    std::string fields = named(name);
    put(fields, uint32_t{8});
    put(fields, value);
    put_record(file, 3, node, fields);
}

void put_stream(std::string& file, uint32_t node, const OniStreamText& stream) {
    std::string added = named(stream.type == 2 ? "Depth" : "Image");
    put(added, stream.type);
    added += stream.codec;
    put(added, uint32_t{1});  // frames, which readers do not believe
    for (int i = 0; i < 3; ++i) put(added, uint64_t{0});
    put_record(file, 13, node, added);
    std::string mode = named("xnMapOutputMode");
    put(mode, uint32_t{12});
    for (const uint32_t value : {stream.extent.width, stream.extent.height, 30u}) put(mode, value);
    put_record(file, 6, node, mode);
    if (stream.view_rad) {
        std::string view = named("xnFOV");
        put(view, uint32_t{16});
        put(view, stream.view_rad->x);
        put(view, stream.view_rad->y);
        put_record(file, 6, node, view);
    }
    if (stream.pixel_format > 0) put_int(file, node, "oniPixelFormat", stream.pixel_format);
    put_int(file, node, "xnMirror", stream.mirrored);
    put_int(file, node, "xnSomethingElse", 7);
}

}  // namespace

std::string oni_recording(const std::vector<OniStreamText>& streams, const std::vector<OniPictureText>& pictures) {
    std::string file = "NI10";
    for (const uint32_t word : {0x00010001u, 0u, ~0u, ~0u, static_cast<uint32_t>(streams.size())}) put(file, word);
    for (uint32_t i = 0; i < streams.size(); ++i) put_stream(file, i + 1, streams[i]);
    std::vector<uint32_t> numbers(streams.size(), 0);
    for (const OniPictureText& picture : pictures) {
        std::string fields;
        put(fields, picture.microseconds);
        put(fields, ++numbers[picture.stream]);
        put_record(file, 10, picture.stream + 1, fields, picture.bytes);
    }
    put_record(file, 11, 0, "");
    return file;
}

std::vector<uint8_t> encode_oni_depth(const std::vector<uint16_t>& values, bool table) {
    std::vector<uint8_t> bytes;
    const auto word = [&](size_t value) {
        bytes.push_back(static_cast<uint8_t>(value & 255));
        bytes.push_back(static_cast<uint8_t>(value >> 8));
    };
    const std::set<uint16_t> sorted(values.begin(), values.end());
    const auto code = [&](uint16_t value) {
        return table ? static_cast<int>(std::distance(sorted.begin(), sorted.find(value))) : int{value};
    };
    if (table) {
        word(sorted.size());
        for (const uint16_t value : sorted) word(value);
    }
    int last = code(values.front());
    word(static_cast<size_t>(last));
    int half = -1;  // of a byte that is not full; below 0: there is none
    int repeats = 0;
    const auto end_repeats = [&] {
        if (repeats > 0) bytes.push_back(static_cast<uint8_t>(0xe0 + repeats));
        repeats = 0;
    };
    for (size_t i = 1; i < values.size(); ++i) {
        const int now = code(values[i]), step = last - now;
        last = now;
        if (std::abs(step) > 6) {
            end_repeats();
            bytes.push_back(static_cast<uint8_t>(half >= 0 ? half << 4 | 15 : 0xff));
            half = -1;
            if (std::abs(step) <= 63) {
                bytes.push_back(static_cast<uint8_t>(step + 192));
            } else {
                bytes.push_back(static_cast<uint8_t>(now >> 8));
                bytes.push_back(static_cast<uint8_t>(now & 255));
            }
        } else if (half < 0) {
            half = step + 6;
        } else {
            const int pair = half << 4 | (step + 6);
            half = -1;
            if (pair == 0x66) {
                if (++repeats == 15) end_repeats();
            } else {
                end_repeats();
                bytes.push_back(static_cast<uint8_t>(pair));
            }
        }
    }
    if (half >= 0) {
        end_repeats();
        bytes.push_back(static_cast<uint8_t>(half << 4 | 13));
    }
    end_repeats();
    return bytes;
}

}  // namespace patina::sensor::testing
