// The run's folder and its journal: points.jsonl, one line per finished point, appended as it finishes.
// Whatever ends the program at whatever moment, the lines before are whole; a torn last line is cut off when
// the run is resumed.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::run {

// What the program must remember of each finished point; the rest stays in the file.
struct JournalEntry {
  std::string id, status, fingerprint;
  uint64_t offset = 0, length = 0;  // of its line in points.jsonl
};

class Journal {
 public:
  enum class Mode { fresh, resume };
  // Makes the folder, takes its lock and reads what is there. Throws InputError when the folder already holds
  // a journal and `mode` is fresh, or when another live run writes there; WriteError when it cannot be
  // written.
  Journal(const std::filesystem::path& folder, Mode mode);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  // What was found wrong and mended while reading: sentences for the user.
  const std::vector<std::string>& remarks() const { return remarks_; }

  // The last record of each point wins: a point that failed and was run again counts once.
  const std::map<std::string, JournalEntry>& entries() const { return entries_; }
  const JournalEntry* find(const std::string& id) const;
  std::string line(const JournalEntry& entry) const;

  // Appends and hands to the operating system before it returns. On a full disk the torn part is taken back
  // and WriteError thrown: everything before it is kept.
  void append(const nlohmann::json& record);

 private:
  void lock();
  void read(Mode mode);
  void take(std::string_view line, uint64_t offset, std::size_t number);
  std::filesystem::path folder_, file_;
  int lock_fd_ = -1, fd_ = -1;
  uint64_t size_ = 0;
  std::map<std::string, JournalEntry> entries_;
  std::vector<std::string> remarks_;
};

// Reads the points of a finished or unfinished run for those who only look at it: one call per record, the
// last of each id, in the journal's order. Throws InputError.
void for_each_point(const std::filesystem::path& run_folder,
                    const std::function<void(const nlohmann::json&)>& visit);

}  // namespace penumbra::run
