#include "base/file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/check.hpp"
#include "base/memory.hpp"

namespace sprekk::base {

std::string read_file(const std::string& path, const std::string& kind, std::size_t limit,
                      const std::function<void(std::string_view)>& check_start) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  SPREKK_CHECK(status.type() != std::filesystem::file_type::not_found, "{}: there is no such file", path);
  SPREKK_CHECK(status.type() != std::filesystem::file_type::none, "{}: cannot be read: {}", path, error.message());
  SPREKK_CHECK(!std::filesystem::is_directory(status), "{}: is a folder, expected {}", path, kind);
  SPREKK_CHECK(std::filesystem::is_regular_file(status), "{}: is a device, pipe or socket, expected {}", path, kind);
  std::ifstream file(path, std::ios::binary);
  SPREKK_CHECK(file, "{}: cannot be read", path);

  const std::size_t size = std::filesystem::file_size(path, error);
  std::string text(std::min<std::size_t>(size, 4096), '\0');
  const auto read = [&](std::size_t from) {
    file.read(text.data() + from, static_cast<std::streamsize>(text.size() - from));
    SPREKK_CHECK(file, "{}: cannot be read beyond byte {}", path, from + file.gcount());
  };
  read(0);
  if (check_start) check_start(text);
  const auto memory = static_cast<std::size_t>(memory_limit());
  SPREKK_CHECK(size <= std::min(limit, memory), "{}: has {} bytes; {} may have {}{}", path, size, kind,
               std::min(limit, memory), memory < limit ? ", the memory of this machine" : "");
  text.resize(size);
  read(std::min<std::size_t>(size, 4096));
  return text;
}

}  // namespace sprekk::base
