#include "io/file.hpp"

#include "base/check.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace sprekk::io {

namespace {

/// Writes all of `content`. Returns 0 or the system's error number.
int write_all(const std::string& path, const std::string& content) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) return errno;
  int error = std::fwrite(content.data(), 1, content.size(), file) == content.size() ? 0 : errno;
  if (std::fclose(file) != 0 && error == 0) error = errno;  // a full disk may be detected only here
  return error;
}

}  // namespace

void write_file(const std::string& path, const std::string& content) {
  const std::string beside = path + ".part";
  int error = write_all(beside, content);
  if (error == 0 && std::rename(beside.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) std::remove(beside.c_str());
  SPREKK_CHECK(error == 0, "{}: cannot be written: {}", path, std::generic_category().message(error));
}

void flush_to_disk(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY);
  const bool done = file >= 0 && ::fsync(file) == 0;
  const int error = errno;
  if (file >= 0) ::close(file);
  std::error_code none;
  const bool not_offered = file >= 0 && (error == EINVAL || error == ENOTSUP);  // on some network file systems
  SPREKK_CHECK(done || (not_offered && std::filesystem::is_directory(path, none)),
               "{}: cannot be written to the disk: {}", path, std::generic_category().message(error));
}

void append_durably(const std::string& path, long long length, const std::string& content) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT, 0666);
  int error = file < 0 || ::ftruncate(file, length) != 0 || ::lseek(file, 0, SEEK_END) != length ? errno : 0;
  for (std::size_t done = 0; error == 0 && done < content.size();) {
    const auto n = ::write(file, content.data() + done, content.size() - done);
    if (n > 0) done += n;
    if (n == 0) error = ENOSPC;  // does not occur in POSIX; avoids an endless loop
    if (n < 0 && errno != EINTR) error = errno;
  }
  if (error == 0 && ::fsync(file) != 0) error = errno;
  if (file >= 0) ::close(file);
  SPREKK_CHECK(error == 0, "{}: cannot be written: {}", path, std::generic_category().message(error));
}

bool overwrite(const std::string& path, const std::string& content) {
  const int file = ::open(path.c_str(), O_WRONLY);
  if (file < 0) return false;
  const auto size = static_cast<off_t>(content.size());
  const bool done = ::lseek(file, 0, SEEK_END) >= size && ::pwrite(file, content.data(), content.size(), 0) == size &&
                    ::ftruncate(file, size) == 0;
  ::close(file);
  return done;
}

void make_directory(const Comm& comm, const std::string& path) {
  base::collectively(comm, [&] {
    if (comm.getRank() != 0) return;
    std::error_code error;
    std::filesystem::create_directories(path, error);
    std::error_code unknown;
    SPREKK_CHECK(std::filesystem::is_directory(path, unknown), "{}: cannot be created as a directory: {}", path,
                 error ? error.message() : "a file with this name exists");
  });
}

}  // namespace sprekk::io
