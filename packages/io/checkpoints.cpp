#include "io/checkpoints.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "io/file.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <zlib.h>

#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

namespace sprekk::io {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr int format = 4;  ///< version of the format; the first version had no number

/// Seal of `content` appended to data with the seal `before`.
Seal seal_of(const std::string& content, const Seal& before = {}) {
  const auto* bytes = reinterpret_cast<const Bytef*>(content.data());
  return {before[0] + static_cast<long long>(content.size()),
          static_cast<long long>(crc32_z(static_cast<uLong>(before[1]), bytes, content.size()))};
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  SPREKK_CHECK(file.good(), "{}: cannot be read", path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Calls work(error). Throws an Error with the path and the system's reason.
template <class Work>
void attempt(const std::string& path, const char* what, const Work& work) {
  std::error_code error;
  work(error);
  SPREKK_CHECK(!error, "{}: cannot be {}: {}", path, what, error.message());
}

void write_durably(const std::string& path, const std::string& content) {
  write_file(path, content);
  flush_to_disk(path);
}

/// Paths of the journal and its copy.
std::array<std::string, 2> journal_files(const std::string& path) {
  return {path + "/journal", path + "/journal_copy"};
}

std::string piece_file(const std::string& folder, int rank) { return fmt::format("{}/piece_{}.h5", folder, rank); }

/// Returns the text of a file on all ranks; rank 0 reads it. With a seal, only the first bytes are used, as many as the
/// seal specifies. Throws an Error if they are damaged. Collective.
std::string read_once(const Comm& comm, const std::string& path, const std::optional<Seal>& seal = {}) {
  std::string text;
  base::collectively(comm, [&] {
    if (comm.getRank() != 0) return;
    text = read_file(path);
    if (!seal) return;
    text.resize(std::min<std::size_t>(text.size(), (*seal)[0]));
    SPREKK_CHECK(seal_of(text) == *seal, "{}: is damaged", path);
  });
  return base::of_rank(comm, 0, text);
}

/// Parses a journal with one entry on each line.
std::vector<json> entries_of(const std::string& journal) {
  std::vector<json> entries;
  std::istringstream lines(journal);
  for (std::string line; std::getline(lines, line);) entries.push_back(json::parse(line));
  return entries;
}

}  // namespace

Checkpoints::Checkpoints(RCP<const Comm> comm, std::string path) : comm_(std::move(comm)), path_(std::move(path)) {}

std::string Checkpoints::folder(long long number) const { return fmt::format("{}/{}", path_, number); }

std::vector<long long> Checkpoints::numbers() const {
  std::vector<long long> found;
  base::collectively(*comm_, [&] {
    std::error_code none;  // if the directory does not exist
    if (comm_->getRank() != 0 || !fs::is_directory(path_, none)) return;
    fs::directory_iterator entries;
    attempt(path_, "read", [&](auto& error) { entries = fs::directory_iterator(path_, error); });
    for (const auto& entry : entries) {
      const std::string name = entry.path().filename();
      if (!name.empty() && name.size() < 18 && name.find_first_not_of("0123456789") == name.npos)
        found.push_back(std::stoll(name));
    }
    std::sort(found.begin(), found.end());
  });
  return base::of_rank(*comm_, 0, found);
}

void Checkpoints::clear() {
  last_ = -1;
  journal_ = {};
  base::collectively(*comm_, [&] {
    std::error_code none;  // if the directory does not exist
    if (comm_->getRank() != 0 || !fs::is_directory(path_, none)) return;
    attempt(path_, "removed", [&](auto& error) { fs::remove_all(path_, error); });
  });
}

void Checkpoints::write(const Checkpoint& checkpoint) {
  const auto before = numbers();
  const long long number = before.empty() ? 0 : before.back() + 1;
  std::string news;
  for (const auto& entry : checkpoint.journal)
    news += entry.dump(-1, ' ', false, json::error_handler_t::replace) + '\n';
  const Seal journal = seal_of(news, journal_);
  const std::string part = folder(number) + ".part";
  const bool first = comm_->getRank() == 0;
  const auto remove_parts = [&] {  // as far as possible; remaining ones are ignored
    std::error_code left;
    for (const auto& entry : fs::directory_iterator(path_, left))
      if (entry.path().extension() == ".part") fs::remove_all(entry.path(), left);
  };
  make_directory(*comm_, path_);
  try {
    base::collectively(*comm_, [&] {
      if (!first) return;
      remove_parts();  // of killed runs
      attempt(part, "made", [&](auto& error) { fs::create_directory(part, error); });
    });
    Seal seal;
    base::collectively(*comm_, [&] {
      const auto piece = to_hdf5(checkpoint.vectors);
      seal = seal_of(piece);
      write_durably(piece_file(part, comm_->getRank()), piece);
    });
    std::vector<Seal> seals(comm_->getSize());
    Teuchos::gatherAll(*comm_, 2, seal.data(), 2 * comm_->getSize(), seals.front().data());
    base::collectively(*comm_, [&] {
      if (!first) return;
      for (const auto& file : journal_files(path_)) append_durably(file, journal_[0], news);
      json sealed = {{"format", format}, {"content", checkpoint.content}, {"pieces", seals}, {"journal", journal}};
      for (const auto& [name, vector] : checkpoint.vectors) sealed["vectors"].push_back(name);
      write_durably(part + "/manifest.json", json{{"sealed", sealed}, {"seal", seal_of(sealed.dump())}}.dump());
      flush_to_disk(part);
      attempt(part, "renamed", [&](auto& error) { fs::rename(part, folder(number), error); });
      flush_to_disk(path_);
    });
  } catch (...) {  // on every rank
    std::error_code ignored;
    if (first) fs::remove_all(part, ignored);
    throw;
  }
  const long long previous = std::exchange(last_, number);
  journal_ = journal;
  base::collectively(*comm_, [&] {
    if (!first) return;
    std::error_code left;  // directories that remain are ignored
    for (const auto old : before)
      if (old != previous)
        fs::rename(folder(old), folder(old) + ".part", left);  // quick rename first, then slow removal
    remove_parts();
  });
}

Checkpoint Checkpoints::read(std::vector<std::string>& damage) {
  const auto candidates = numbers();
  std::vector<std::string> damaged;
  for (auto number = candidates.rbegin(); number != candidates.rend(); ++number) {
    try {
      Seal journal;
      auto checkpoint = read(*number, journal);
      const auto text = read_journal(journal, damage);
      for (const auto& what : damaged) damage.push_back(what + "; the run continues from the checkpoint before");
      checkpoint.journal = entries_of(text);
      last_ = *number;
      journal_ = journal;
      return checkpoint;
    } catch (const Error& error) {
      damaged.push_back(error.what());
    }
  }
  throw Error(fmt::format("{}: there is no complete checkpoint to continue from{}", path_,
                          damaged.empty() ? "" : fmt::format("; {}", fmt::join(damaged, "; "))));
}

std::string Checkpoints::read_journal(const Seal& seal, std::vector<std::string>& damage) const {
  std::optional<std::string> text;
  std::vector<std::string> damaged, reasons;
  for (const auto& file : journal_files(path_)) try {
      text = read_once(*comm_, file, seal);
    } catch (const Error& error) {
      damaged.push_back(file);
      reasons.push_back(error.what());
    }
  if (!text) throw Error(reasons.front());
  for (const auto& reason : reasons) damage.push_back(reason + "; its intact copy is used");
  try {
    if (comm_->getRank() == 0)
      for (const auto& file : damaged) write_durably(file, *text);
  } catch (const Error&) {  // one intact file is sufficient
  }
  return *text;
}

Checkpoint Checkpoints::read(long long number, Seal& journal) const {
  const std::string manifest_file = folder(number) + "/manifest.json";
  const std::string text = read_once(*comm_, manifest_file);
  const json manifest = json::parse(text, nullptr, false);
  SPREKK_CHECK(manifest.is_object() && manifest.contains("seal") && manifest.contains("sealed") &&
                   manifest["sealed"].contains("journal") &&
                   manifest["seal"] == json(seal_of(manifest["sealed"].dump())),
               "{}: is damaged", manifest_file);
  const int written = manifest["sealed"].value("format", 1);
  SPREKK_CHECK(written == format,
               "{}: is of {} version of Sprekk (format {}, this one reads {}): run the scene again without --restart",
               folder(number), written < format ? "an earlier" : "a later", written, format);
  const auto& pieces = manifest["sealed"]["pieces"];
  std::map<std::string, NumberedValues> values;
  base::collectively(*comm_, [&] {
    for (int k = comm_->getRank(); k < static_cast<int>(pieces.size()); k += comm_->getSize()) {
      const std::string file = piece_file(folder(number), k), content = read_file(file);
      SPREKK_CHECK(pieces[k] == json(seal_of(content)), "{}: is damaged", file);
      from_hdf5(content, file, values);
    }
  });
  journal = manifest["sealed"]["journal"];
  Checkpoint checkpoint{{}, manifest["sealed"]["content"], {}};
  for (const auto& name : manifest["sealed"]["vectors"]) {
    const auto& here = values[name];
    const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
    const auto map = rcp(new const fields::Map(
        unknown, Teuchos::ArrayView<const GlobalIndex>(here.numbers.data(), here.numbers.size()), 0, comm_));
    checkpoint.vectors[name] =
        rcp(new fields::Vector(map, Teuchos::ArrayView<const Real>(here.values.data(), here.values.size())));
  }
  return checkpoint;
}

}  // namespace sprekk::io
