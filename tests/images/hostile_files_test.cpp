// Files of another kind than expected, files that claim false sizes, and files that change while they are read.

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "etendue/film/image_tools.h"
#include "images/image_library.h"
#include "images/linear_image.h"
#include "support/process.h"

namespace etendue {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool sanitized = true;
#elif defined(__has_feature)
constexpr bool sanitized = __has_feature(address_sanitizer);
#else
constexpr bool sanitized = false;
#endif

/// What reads a file of one kind: a scene or a command in which %s stands for the file's name.
struct Reader {
  const char* name;
  const char* object;  ///< part of the scene; empty: the command names the file
  std::vector<std::string> command;
};

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all = {
      {"a.etd", "", {"check", "%s"}},
      {"include.etd", "include", {}},
      {"plugin.so", "plugin", {}},
      {"a.png", "Sphere { shader: Lambertian { color: ImageMap { file: \"%s\" } } }", {}},
      {"b.exr", "Sphere { shader: Lambertian { color: ImageMap { file: \"%s\", channel: \"R\" } } }", {}},
      {"c.hdr", "Environment { emission: EnvironmentEmission { file: \"%s\" } }", {}},
      {"d.png", "Point { emission: ProjectorEmission { file: \"%s\" } }", {}},
      {"a.ply", "TriangleMesh { file: \"%s\" }", {}},
      {"a.obj", "SubdivisionSurface { file: \"%s\" }", {}},
      {"a.csv", "Sphere { shader: Lambertian { color: spectrum(\"%s\") } }", {}},
      {"a.spd", "Sphere { shader: Lambertian { color: spectrum(\"%s\") } }", {}},
      {"a.npy", "SignedDistanceGrid { file: \"%s\" }", {}},
      {"a.ies", "Point { emission: IesEmission { file: \"%s\" } }", {}},
      {"a.binary", "Sphere { shader: MerlShader { file: \"%s\" } }", {}},
      {"a.bsdf", "Sphere { shader: RglShader { file: \"%s\" } }", {}},
      {"e.exr", "", {"image", "info", "%s"}},
      {"e.npy", "", {"image", "diff", "%s", "%s"}},
      {"f.exr", "", {"image", "tonemap", "%s", "out.png"}},
      {"a.part", "", {"image", "merge", "%s", "-o", "out.npy"}},
      {"b.part", "", {"render", "good.etd", "--resume", "%s", "-o", "out.npy"}},
      {"c.part", "", {"render", "good.etd", "--continue", "%s", "-o", "out.npy"}},
      {"b.so", "", {"classes", "--plugin", "%s"}},
  };
  return all;
}

std::string filled(std::string text, const std::string& name) {
  for (size_t at; (at = text.find("%s")) != std::string::npos;) text.replace(at, 2, name);
  return text;
}

class HostileFiles : public testing::Test {
 protected:
  static std::string scene(const std::string& object) {
    return "Job { camera: PerspectiveCamera { from: [0, 0, 5], to: [0, 0, 0] }, image: ImageBuffer { width: 4, height: 4 }\n"
           " renderer: PathTracer { samples: 2 }\n scene: BruteForceScene { objects: [\n" +
           object + "\n ] } }";
  }
  void SetUp() override { folder.write("good.etd", scene("Sphere {}")); }

  /// Runs the program with at most 4 GB of memory for at most a minute (status 124: it took longer). With sanitizers the memory
  /// is not limited: their address space is terabytes.
  int run(const std::vector<std::string>& arguments, const std::string& kilobytes = "4194304") {
    std::vector<std::string> all = {"-c", (sanitized ? "" : "ulimit -v " + kilobytes + "; ") + "exec timeout 60 \"$0\" \"$@\"",
                                    ETENDUE_BINARY_DIR "/etendue"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    Process process("/bin/sh", all, folder);
    const int status = process.wait();
    err = process.err();
    return status;
  }
  /// Runs a reader on a file of this name in the folder.
  int read(const Reader& reader, const std::string& name, const std::string& kilobytes = "4194304") {
    if (reader.command.empty()) {
      std::string text = filled(scene(reader.object), name);
      const std::string word = reader.object;
      if (word == "include" || word == "plugin") text = word + " \"" + name + "\"\n" + scene("Sphere {}");
      folder.write("scene.etd", text);
      return run({"check", "scene.etd"}, kilobytes);
    }
    std::vector<std::string> command;
    for (const std::string& word : reader.command) command.push_back(filled(word, name));
    return run(command, kilobytes);
  }
  bool said(const std::string& part) const { return err.find(part) != std::string::npos; }

  TemporaryFolder folder;
  std::string err;
};

TEST_F(HostileFiles, what_is_no_file_is_refused_at_once_by_every_reader) {
  for (const Reader& reader : readers()) {
    ASSERT_EQ(::mkfifo((folder / reader.name).c_str(), 0600), 0);
    EXPECT_EQ(read(reader, reader.name), 2) << reader.name << ": " << err;
    EXPECT_TRUE(said(reader.name) && said("it is a pipe")) << reader.name << ": " << err;
    std::filesystem::remove(folder / reader.name);

    std::filesystem::create_symlink("/dev/zero", folder / reader.name);
    EXPECT_EQ(read(reader, reader.name), 2) << reader.name << ": " << err;
    EXPECT_TRUE(said(reader.name) && said("it is a device")) << reader.name << ": " << err;
    std::filesystem::remove(folder / reader.name);

    std::filesystem::create_directory(folder / reader.name);
    EXPECT_EQ(read(reader, reader.name), 2) << reader.name << ": " << err;
    EXPECT_TRUE(said(reader.name) && said("it is a folder")) << reader.name << ": " << err;
    std::filesystem::remove(folder / reader.name);
  }
}

TEST_F(HostileFiles, sockets_are_refused) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, (folder / "a.ply").c_str(), sizeof address.sun_path - 1);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(read({"a.ply", "TriangleMesh { file: \"%s\" }", {}}, "a.ply"), 2);
  EXPECT_TRUE(said("a.ply") && said("it is a socket")) << err;
  ::close(socket);
}

TEST_F(HostileFiles, a_description_may_come_from_a_file_that_is_standard_input) {
  Process process("/bin/sh", {"-c", "exec \"$0\" check /dev/stdin < good.etd", ETENDUE_BINARY_DIR "/etendue"}, folder);
  EXPECT_EQ(process.wait(), 0) << process.err();
  Process piped("/bin/sh", {"-c", "cat good.etd | \"$0\" check /dev/stdin", ETENDUE_BINARY_DIR "/etendue"}, folder);
  EXPECT_EQ(piped.wait(), 2);
  EXPECT_NE(piped.err().find("it is a pipe"), std::string::npos) << piped.err();
}

// The file is far larger than the part that is read before it shrinks; an older version of the program died of SIGBUS at one of
// the delays.
TEST_F(HostileFiles, a_mesh_that_shrinks_while_it_is_read_ends_nothing) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 20000000\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1000000\nproperty list uchar int vertex_indices\nend_header\n";
  folder.write("scene.etd", scene("TriangleMesh { file: \"big.ply\" }"));
  for (int delay = 10; delay <= 160; delay *= 2) {
    folder.write("big.ply", header);
    std::filesystem::resize_file(folder / "big.ply", 300u << 20);
    Process process(ETENDUE_BINARY_DIR "/etendue", {"check", "scene.etd"}, folder);
    std::this_thread::sleep_for(std::chrono::milliseconds(delay));
    std::filesystem::resize_file(folder / "big.ply", 4096);
    EXPECT_LT(process.wait(), 128) << "after " << delay << " ms: " << process.err();
    EXPECT_NE(process.err().find("big.ply"), std::string::npos) << process.err();
  }
}

TEST_F(HostileFiles, little_images_that_claim_much_are_refused_for_what_they_claim) {
  for (const char* const name : {"bomb282.exr", "bomb568.exr", "oom355.exr"}) {
    std::filesystem::copy_file(std::string(ETENDUE_SOURCE_DIR "/tests/hostile/") + name, folder / name);
    for (const Reader& reader : {Reader{"", "", {"image", "info", "%s"}}, readers()[3], readers()[4], readers()[5]}) {
      EXPECT_EQ(read(reader, name), 2) << err;
      EXPECT_TRUE(said(name)) << err;
      EXPECT_FALSE(said("memory") || said("bad_alloc")) << err;
    }
  }
  // A PNG and a TGA of some hundred bytes that claim to be as large as the format allows.
  const auto big_endian = [](std::uint32_t n) { return std::string{char(n >> 24), char(n >> 16), char(n >> 8), char(n)}; };
  const std::string png = "\x89PNG\r\n\x1a\n" + big_endian(13) + "IHDR" + big_endian(60000) + big_endian(60000) +
                          std::string("\x08\x02\0\0\0", 5) + big_endian(0) + big_endian(200) + "IDAT" + std::string(200, 'x');
  std::string tga(18, '\0');
  tga[2] = 10;
  tga[12] = tga[13] = tga[14] = tga[15] = char(0xff);
  tga[16] = 24;
  folder.write("big.png", png);
  folder.write("big.tga", tga + std::string(300, '\xff'));
  for (const char* name : {"big.png", "big.tga"})
    for (const Reader& reader : {Reader{"", "", {"image", "info", "%s"}}, readers()[3]}) {
      EXPECT_EQ(read(reader, name), 2) << err;
      EXPECT_TRUE(said(name)) << err;
      EXPECT_FALSE(said("memory") || said("bad_alloc")) << err;
    }
}

// A PNG of 73 bytes whose text chunk claims 2 GB, which were allocated and filled before the end of the file was noticed.
TEST_F(HostileFiles, a_png_holds_what_its_pieces_claim) {
  const std::string header("\0\0\0\rIHDR\0\0\0\x9\0\0\0\x7\x8\x6\0\0\0\xda\x9b\x67\x60", 25);
  const std::string png = "\x89PNG\r\n\x1a\n" + header + "\x7f\xff\xff\xfe" + "tEXtComment" + std::string(20, '\0');
  folder.write("text.png", png);
  EXPECT_EQ(run({"image", "info", "text.png"}, "2000000"), 2) << err;
  EXPECT_TRUE(said("text.png") && said("claims 2147483646 bytes")) << err;
}

// A BMP whose pixels of 24 bits claim the packing of 8-bit pixels: the image library's reader read beyond its unpacked data.
TEST_F(HostileFiles, a_bmp_is_packed_in_a_way_that_goes_with_its_bits) {
  const auto bmp = [](char bits, char packing, char begin) {
    std::string file("BM\x4a\x4\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x7\0\0\0\x5\0\0\0\x1\0\x18\0\x1\0\0\0", 34);
    file[10] = begin;
    file[28] = bits;
    file[30] = packing;
    return file + std::string(1064, '\x1');
  };
  folder.write("plain.bmp", bmp(24, 0, 54));
  folder.write("packed.bmp", bmp(24, 1, 54));
  folder.write("way.bmp", bmp(8, 7, 54));
  std::string beyond = bmp(24, 0, 54);
  beyond[11] = '\x7';
  folder.write("beyond.bmp", beyond);
  EXPECT_EQ(run({"image", "info", "plain.bmp"}, "2000000"), 0) << err;
  EXPECT_EQ(run({"image", "info", "packed.bmp"}, "2000000"), 2) << err;
  EXPECT_TRUE(said("packed.bmp") && said("24 bits cannot be packed")) << err;
  EXPECT_EQ(run({"image", "info", "way.bmp"}, "2000000"), 2) << err;
  EXPECT_TRUE(said("8 bits cannot be packed in the way 7")) << err;
  EXPECT_EQ(run({"image", "info", "beyond.bmp"}, "2000000"), 2) << err;
  EXPECT_TRUE(said("begin at byte 1846 of 1098")) << err;
}

// A TIFF whose position plus width overflows a 32-bit integer.
TEST_F(HostileFiles, windows_of_pictures_lie_where_they_can_be_counted) {
  std::string tiff("II*\0\x8\0\0\0", 8);
  const auto add = [&](std::uint32_t number, int bytes) {
    for (int i = 0; i < bytes; ++i) tiff += char(number >> 8 * i);
  };
  const std::uint32_t entries[][3] = {{256, 4, 200}, {257, 4, 1}, {258, 3, 8},   {259, 3, 1},   {262, 3, 1},  {273, 4, 166},
                                      {277, 3, 1},   {278, 4, 1}, {279, 4, 200}, {286, 5, 150}, {287, 5, 158}};
  add(std::size(entries), 2);
  for (const auto& [tag, type, value] : entries) {  // tag, type of number, count, the number or its offset
    add(tag, 2);
    add(type, 2);
    add(1, 4);
    add(value, 4);
  }
  add(0, 4);
  tiff.resize(150);
  for (const std::uint32_t number : {2147483520u, 1u, 0u, 1u}) add(number, 4);  // x and y, as fractions
  folder.write("far.tif", tiff + std::string(200, '\x7f'));
  try {
    read_image(folder / "far.tif");
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("its windows reach to pixel 2147483520"), std::string::npos) << e.what();
  }
}

// The image library reads 28 formats, and its readers of rare formats crash or hang on damaged files. A file's first bytes, not
// its name, select the reader, and no other reader is tried.
TEST_F(HostileFiles, images_of_formats_that_are_not_read_reach_no_reader) {
  const std::vector<std::pair<const char*, std::string>> kinds = {
      {"iff", "FOR4"},          {"dds", "DDS "}, {"psd", "8BPS"},    {"gif", "GIF89a"},       {"ico", "icon"},
      {"pic", "S\x80\xf6\x34"}, {"dpx", "SDPX"}, {"fits", "SIMPLE"}, {"mp4", "    ftypmp42"}, {"rla", "    "}};
  const auto answer = [](const auto& reader, const std::string& path) -> std::string {
    try {
      reader(path);
      return {};
    } catch (const Error& e) {
      return e.what();
    }
  };
  const auto whole = [](const std::string& path) { read_image(path); };
  const auto texture = [](const std::string& path) { image_library().open_texture(path, "auto", ""); };
  const auto linear = [](const std::string& path) { image_library().read_linear(path, "auto", ""); };
  for (const auto& [ending, beginning] : kinds)
    for (const std::string& name : {std::string("a.") + ending, std::string("a.png")}) {
      const std::string path = folder.write(name, beginning + std::string(300, '\0'));
      for (const std::string& said : {answer(whole, path), answer(texture, path), answer(linear, path)})
        EXPECT_NE(said.find("does not begin as an image"), std::string::npos) << name << ": " << said;
    }
  // A picture of one pixel (netpbm's "plain" format), whatever it is named.
  for (const char* const name : {"a.ppm", "b.iff", "c.nef", "d.mp4", "e"})
    EXPECT_EQ(answer(whole, folder.write(name, "P3 1 1 255 255 0 0\n")), "") << name;
}

// Sparse files of 3 GB, with 2 GB of memory allowed.
TEST_F(HostileFiles, memory_that_runs_out_names_the_file_and_who_asked) {
  if (sanitized) GTEST_SKIP() << "memory cannot be limited for a program with sanitizers";
  for (const Reader& reader : readers()) {
    const std::string name = reader.name, ending = name.substr(name.find('.') + 1);
    std::string beginning;
    if (ending == "ply")
      beginning =
          "ply\nformat binary_little_endian 1.0\nelement vertex 200000000\nproperty float x\nproperty float y\nproperty float "
          "z\n"
          "element face 10\nproperty list uchar int vertex_indices\nend_header\n";
    if (ending == "npy")
      beginning =
          std::string("\x93NUMPY\x01\0\x76\0", 10) + "{'descr': '<f4', 'fortran_order': False, 'shape': (10, 10, 8000000), }";
    folder.write(name, beginning);
    std::filesystem::resize_file(folder / name, 3u << 30);
    EXPECT_EQ(read(reader, name, "2000000"), 2) << name << ": " << err;
    EXPECT_TRUE(said(name)) << name << ": " << err;
    std::filesystem::remove(folder / name);
  }
}

}  // namespace
}  // namespace etendue
