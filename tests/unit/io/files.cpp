#include "base/check.hpp"
#include "io/directory_lock.hpp"
#include "io/json.hpp"
#include "scratch.hpp"

#include <nlohmann/json.hpp>
#include <Tpetra_Core.hpp>

#include <sys/resource.h>

#include <csignal>
#include <limits>
#include <string>
#include <vector>

namespace sprekk::test {

namespace fs = std::filesystem;

TEST(Json, ReadsBackToTheSameBits) {
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const std::vector<double> values{
      0.1, 1.0 / 3, -1e-300, 5e-324, std::numeric_limits<double>::max(), 123456789.123456789};
  const nlohmann::json written{{"values", values}, {"name", "slip \"x\""}, {"n", 12345678901234LL}};
  io::write_json(*comm, scratch / "results.json", written);
  const auto read = nlohmann::json::parse(content(scratch / "results.json"));
  EXPECT_EQ(read, written);
  EXPECT_EQ(read["values"].get<std::vector<double>>(), values);
  EXPECT_FALSE(fs::exists(scratch / "results.json.part"));
}

TEST(Json, FullDiskLeavesTheEarlierFile) {
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const std::string path = scratch / "results.json";
  io::write_json(*comm, path, {{"step", 1}});
  scratch.on_rank_0([&] { fs::create_symlink("/dev/full", path + ".part"); });
  const auto message = error_of<Error>([&] { io::write_json(*comm, path, {{"step", 2}}); });
  EXPECT_TRUE(contains(message, path)) << message;
  EXPECT_TRUE(contains(message, "No space left")) << message;
  EXPECT_EQ(nlohmann::json::parse(content(path))["step"], 1);
  comm->barrier();                             // all ranks have read
  io::write_json(*comm, path, {{"step", 3}});  // the failed attempt does not block the next one
  EXPECT_EQ(nlohmann::json::parse(content(path))["step"], 3);
}

TEST(Json, MissingDirectoryIsAnErrorOnEveryRank) {
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const std::string path = scratch / "nowhere/results.json";
  const auto message = error_of<Error>([&] { io::write_json(*comm, path, {}); });
  EXPECT_TRUE(contains(message, path)) << message;
  EXPECT_TRUE(contains(message, "No such file")) << message;
}

TEST(Json, IsWrittenInPlaceWhereThereIsRoom) {
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const std::string path = scratch / "results.json";
  EXPECT_FALSE(io::overwrite_json(*comm, path, {}));  // the file does not exist
  io::write_json(*comm, path, {{"status", "running"}, {"steps", {1, 2, 3}}});
  scratch.on_rank_0([&] { fs::create_symlink("/dev/full", path + ".part"); });
  EXPECT_TRUE(io::overwrite_json(*comm, path, {{"status", "failed"}, {"steps", {1, 2, 3}}}));
  EXPECT_FALSE(io::overwrite_json(*comm, path, {{"status", std::string(100, '?')}}));
  comm->barrier();
  EXPECT_EQ(nlohmann::json::parse(content(path)), nlohmann::json({{"status", "failed"}, {"steps", {1, 2, 3}}}));
}

TEST(DirectoryLock, IsConstrainedByOne) {
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const std::string path = scratch / "made/below";
  {
    io::DirectoryLock first(comm, path), second(comm, path);
    EXPECT_FALSE(first.has_directory());
    EXPECT_EQ(first.take(), "");
    EXPECT_EQ(first.take(), "");
    EXPECT_TRUE(second.has_directory());
    const auto message = error_of<Error>([&] { second.take(); });
    EXPECT_TRUE(contains(message, path + ": another run (process ")) << message;
  }
  comm->barrier();
  EXPECT_FALSE(fs::exists(path + "/.lock"));
  comm->barrier();
  scratch.on_rank_0([&] { std::ofstream(path + "/.lock") << "process 1 on moon\n"; });  // lock of a killed process
  EXPECT_EQ(io::DirectoryLock(comm, path).take(), "");
}

TEST(AppendDurably, KeepsWhatWasBefore) {
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  const std::string path = scratch / "journal";
  scratch.on_rank_0([&] {
    io::append_durably(path, 0, "one\ntwo\nthr");
    io::append_durably(path, 8, "three\n");
    EXPECT_EQ(content(path), "one\ntwo\nthree\n");
    ::rlimit before;
    ::getrlimit(RLIMIT_FSIZE, &before);
    const ::rlimit little{1000, before.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &little);
    const auto message = error_of<Error>([&] { io::append_durably(path, 8, std::string(2000, 'x')); });
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(message, path + ": cannot be written: File too large");
    EXPECT_EQ(content(path).substr(0, 9), "one\ntwo\nx");
    io::append_durably(path, 8, "four\n");
    EXPECT_EQ(content(path), "one\ntwo\nfour\n");
    EXPECT_THROW(io::append_durably(scratch / "nowhere/journal", 0, ""), Error);
  });
}

TEST(FlushToDisk, ToleratesOnlyDirectoriesThatCannotBe) {
  io::flush_to_disk("/proc");                                                  // returns EINVAL
  for (const std::string path : {"/dev/null", "/proc/self/stat", "/nowhere"})  // EINVAL for other files; missing file
    EXPECT_TRUE(contains(error_of<Error>([&] { io::flush_to_disk(path); }), path)) << path;
}

TEST(MakeDirectory, MakesParentsAndKeepsContent) {
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  io::make_directory(*comm, scratch / "a b/c");
  EXPECT_TRUE(fs::is_directory(scratch / "a b/c"));
  scratch.on_rank_0([&] { io::write_file(scratch / "a b/c/file", "text"); });
  io::make_directory(*comm, scratch / "a b/c");
  EXPECT_EQ(content(scratch / "a b/c/file"), "text");
}

TEST(MakeDirectory, FileInTheWayAndProc) {
  const auto comm = Tpetra::getDefaultComm();
  const Scratch scratch(*comm);
  scratch.on_rank_0([&] { io::write_file(scratch / "file", ""); });
  for (const auto& path : {scratch / "file", scratch / "file/below", std::string("/proc/sprekk")}) {
    const auto message = error_of<Error>([&] { io::make_directory(*comm, path); });
    EXPECT_TRUE(contains(message, path + ": cannot be created as a directory: ")) << message;
  }
}

}  // namespace sprekk::test
