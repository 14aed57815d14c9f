#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "scenes/files/mesh_file.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/environment.h"
#include "sensor/files/exr_file.h"
#include "sensor/files/picture_file.h"
#include "sensor/inspect.h"
#include "sensor/open.h"
#include "sensor/truth.h"
#include "sensor/write_sequence.h"
#include "tests/scenes/scene_json.h"
#include "tests/sensor/oni_recording.h"
#include "tests/sensor/recording_rig.h"
#include "tests/sensor/sequences.h"

// Every reader, on files that chance has damaged: it reads them or throws an Error that names a file, and nothing else.

namespace patina::sensor::hostile_files_test {
namespace {

using namespace testing;
namespace fs = std::filesystem;

class Mutation {
  public:
    explicit Mutation(uint32_t seed) : random_(seed) {}

    std::string of(std::string bytes) {
        for (int rounds = 1 + static_cast<int>(random_() % 3); rounds > 0; --rounds) change(bytes);
        return bytes;
    }

  private:
    size_t below(size_t count) { return count == 0 ? 0 : random_() % count; }

    void change(std::string& bytes) {
        const size_t at = below(bytes.size());
        switch (random_() % 6) {
            case 0: bytes.resize(at); break;
            case 1: bytes.insert(at, std::string(1 + below(40), static_cast<char>(random_()))); break;
            case 2: bytes.erase(at, 1 + below(40)); break;
            case 3: bytes.insert(at, bytes.substr(below(bytes.size()), below(60))); break;
            case 4: replace_number(bytes, at); break;
            default:
                if (!bytes.empty()) bytes[at] = static_cast<char>(bytes[at] ^ 1 << random_() % 8);
        }
    }

    /// The first number behind `at` becomes an extreme one.
    void replace_number(std::string& bytes, size_t at) {
        static const std::vector<std::string> kExtremes{"0",
                                                        "-1",
                                                        "1e308",
                                                        "-1e308",
                                                        "1e-320",
                                                        "4294967295",
                                                        "4294967296",
                                                        "18446744073709551615",
                                                        "-9223372036854775808",
                                                        "nan",
                                                        "inf",
                                                        "null",
                                                        "[]",
                                                        "{}",
                                                        "\"\"",
                                                        "65536",
                                                        "0.5",
                                                        "1e9",
                                                        "[[[[[[]]]]]]"};
        const size_t begin = bytes.find_first_of("0123456789-", at);
        if (begin == std::string::npos) return;
        const size_t end = std::min(bytes.find_first_not_of("0123456789.e+-", begin), bytes.size());
        bytes.replace(begin, end - begin, kExtremes[below(kExtremes.size())]);
    }

    std::mt19937 random_;
};

class HostileFiles : public ::testing::Test {
  protected:
    /// Damages `file` in many ways, one after the other, and reads.
    void attack(const std::string& file, int times, const std::function<void()>& read) {
        const std::string whole = read_text(folder_ / file);
        ASSERT_FALSE(whole.empty());
        ASSERT_NO_THROW(read()) << file << " as it should be";
        int refused = 0;
        for (int seed = 0; seed < times; ++seed) {
            write_text(folder_ / file, Mutation(static_cast<uint32_t>(seed)).of(whole));
            try {
                read();
            } catch (const Error& error) {
                ++refused;
                EXPECT_NE(std::string(error.what()).find((folder_ / "").string()), std::string::npos)
                    << file << ", seed " << seed << " names no file: " << error.what();
            } catch (const std::exception& other) {
                ADD_FAILURE() << file << ", seed " << seed << " throws no Error: " << other.what();
            }
        }
        EXPECT_GT(refused, times / 20) << file << ": the attack is too weak to tell";
        write_text(folder_ / file, whole);
    }

    void attack_sequence(const std::string& sequence, const std::vector<std::string>& files) {
        for (const std::string& file : files) {
            int skipped = 0;
            const std::string path = sequence + "/" + file;
            const std::string whole = read_text(folder_ / path);
            for (int seed = 0; seed < 60; ++seed) {
                write_text(folder_ / path, Mutation(static_cast<uint32_t>(seed)).of(whole));
                try {
                    const auto source = open_sequence(folder_ / sequence);
                    skipped += inspect(*source).skipped.empty() ? 0 : 1;
                } catch (const Error&) {
                    ++skipped;
                } catch (const std::exception& other) {
                    ADD_FAILURE() << path << ", seed " << seed << " throws no Error: " << other.what();
                }
            }
            EXPECT_GT(skipped, 3) << path << ": the attack is too weak to tell";
            write_text(folder_ / path, whole);
        }
    }

    const TemporaryFolder folder_;
};

TEST_F(HostileFiles, NativeSequences) {
    write_native(folder_ / "s", 2);
    attack_sequence("s", {"sequence.json", "color/000000.png", "depth/000001.png", "trajectory.txt", "timestamps.txt",
                          "exposures.txt"});
}

TEST_F(HostileFiles, SequencesOfOtherPictures) {
    write_native(folder_ / "s", 1);
    fs::remove(folder_ / "s/color/000000.png");
    write_jpeg(folder_ / "s/color/000000.jpg", std::get<Image<SrgbPixel>>(test_frame(0, {32, 24}, {16, 12}).color));
    attack_sequence("s", {"color/000000.jpg"});
    fs::remove(folder_ / "s/color/000000.jpg");
    write_exr_color(folder_ / "s/color/000000.exr", Image<glm::vec3>({32, 24}, glm::vec3(0.5f)));
    attack_sequence("s", {"color/000000.exr"});
}

TEST_F(HostileFiles, SevenScenesAndTum) {
    write_seven_scenes(folder_ / "seven", {0, 1});
    attack_sequence("seven", {"frame-000000.pose.txt", "frame-000000.color.jpg", "frame-000001.depth.png"});
    write_tum(folder_ / "tum", 1);
    attack_sequence("tum", {"rgb.txt", "depth.txt", "groundtruth.txt"});
}

TEST_F(HostileFiles, Open3d) {
    write_native(folder_ / "s", 2);
    for (const char* name : {"sequence.json", "trajectory.txt", "timestamps.txt", "exposures.txt"})
        fs::remove((folder_ / "s") / name);
    fs::remove_all(folder_ / "s/depth");
    fs::create_directories(folder_ / "s/depth");
    for (uint32_t i = 0; i < 2; ++i)
        write_png((folder_ / "s/depth") / (picture_stem(i) + ".png"), Image<uint16_t>({32, 24}, uint16_t(1000 + i)));
    write_text(folder_ / "s/intrinsic.json",
               R"({"width": 32, "height": 24, "intrinsic_matrix": [14, 0, 0, 0, 13, 0, 7, 6, 1]})");
    attack_sequence("s", {"intrinsic.json", "color/000000.png", "depth/000001.png"});
}

TEST_F(HostileFiles, Recordings) {
    write_recording(folder_ / "room.patina", 3);
    attack("room.patina", 200, [&] { inspect(*open_sequence(folder_ / "room.patina")); });
}

TEST_F(HostileFiles, RecordingsOfOpenNi) {
    constexpr Extent2D kExtent{8, 6};
    std::vector<OniPictureText> pictures;
    for (uint32_t i = 0; i < 2; ++i) {
        const std::vector<uint16_t> depth(kExtent.area(), static_cast<uint16_t>(1000 + i));
        pictures.push_back({0, 1'000'000 + i * 33'333, encode_oni_depth(depth, true)});
        pictures.push_back({1, 1'000'000 + i * 33'333, std::vector<uint8_t>(3 * kExtent.area(), 90)});
    }
    const std::string whole = oni_recording(
        {{2, "16zT", kExtent, 100, std::nullopt, false}, {3, "NONE", kExtent, 200, std::nullopt, false}}, pictures);
    write_text(folder_ / "room.oni", whole);
    attack("room.oni", 400, [&] {
        const auto skipped = inspect(*open_sequence(folder_ / "room.oni")).skipped;
        if (!skipped.empty()) throw Error(skipped.front().reason);
    });
}

TEST_F(HostileFiles, LightsMaterialsAndScenes) {
    const Light light{{0, -2, 0}, {1, 1, 1}, 0.1};
    const AreaLight window{{0, 0, 2}, {0.5, 0, 0}, {0, 0.5, 0}, {1, 2, 3}, true};
    write_lights(folder_ / "lights.json", {&light, 1}, glm::dvec3(0.1), {&window, 1});
    attack("lights.json", 300, [&] {
        read_windows(folder_ / "lights.json");
        read_lights(folder_ / "lights.json");
        read_ambient(folder_ / "lights.json");
    });
    const Material material{1, "floor", glm::dvec3(0.5), glm::dvec3(0.1), 0.2};
    write_materials(folder_ / "materials.json", {&material, 1});
    attack("materials.json", 300, [&] { read_materials(folder_ / "materials.json"); });
    write_text(folder_ / "scene.json", scenes::testing::small_scene().dump(1));
    attack("scene.json", 300, [&] { scenes::load_scene((folder_ / "scene.json").string()); });
}

TEST_F(HostileFiles, Environments) {
    std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n";
    for (int i = 0; i < 8 * 16; ++i) hdr += std::string("\x80\x40\x20\x81", 4);
    write_text(folder_ / "e.hdr", hdr);
    attack("e.hdr", 300, [&] { scenes::read_environment(folder_ / "e.hdr"); });
    write_exr_color(folder_ / "e.exr", Image<glm::vec3>({16, 8}, glm::vec3(0.5f)));
    attack("e.exr", 300, [&] { scenes::read_environment(folder_ / "e.exr"); });
}

TEST_F(HostileFiles, Meshes) {
    write_text(folder_ / "m.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1 4/1/1\n");
    const std::string header =
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    write_text(folder_ / "a.ply",
               "ply\nformat ascii 1.0\n" + header + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
    std::string binary = "ply\nformat binary_little_endian 1.0\n" + header;
    const float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    binary += std::string(reinterpret_cast<const char*>(positions), sizeof(positions));
    for (const int32_t second : {1, 2}) {
        const int32_t indices[] = {0, second, second + 1};
        binary += '\3' + std::string(reinterpret_cast<const char*>(indices), sizeof(indices));
    }
    write_text(folder_ / "b.ply", binary);
    const std::string gltf =
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, "translation": [1, 2, 3], "children": [1]}, {"mesh": 0, "scale": [2, 2, -1]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 4}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "byteOffset": 0},
                          {"bufferView": 1, "componentType": 5121, "count": 3, "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 3}],
            "buffers": [{"byteLength": 39,
                         "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAEC"}]})";
    write_text(folder_ / "m.gltf", gltf);
    for (const char* name : {"m.obj", "a.ply", "b.ply", "m.gltf"}) {
        attack(name, 500,
               [&] { scenes::read_mesh(folder_ / name, {.normals = scenes::MeshNormals::kSmooth, .height_m = 1}); });
    }
}

}  // namespace
}  // namespace patina::sensor::hostile_files_test
