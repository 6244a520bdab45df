// SPDX-License-Identifier: Apache-2.0
#include "ledger/sums.h"

#include <charconv>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <sqlite3.h>
#include <stdexcept>

#include "base/log.h"

namespace wellspring::ledger {

using namespace std::chrono;

void add(Sums& to, const Sums& more) {
  for (const auto& [key, value] : more) to[key] += value;
}

std::string day_text(int64_t day) {
  const year_month_day date{sys_days{days{day}}};
  return fmt::format("{:04}-{:02}-{:02}", int(date.year()), unsigned(date.month()),
                     unsigned(date.day()));
}

std::optional<int64_t> parse_day(std::string_view text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return {};
  auto number = [&](size_t from, size_t count) {
    int value = -1;
    const char* end = text.data() + from + count;
    auto [last, error] = std::from_chars(text.data() + from, end, value);
    return error == std::errc() && last == end ? value : -1;
  };
  const int y = number(0, 4), m = number(5, 2), d = number(8, 2);
  if (y < 0 || m < 0 || d < 0) return {};
  const year_month_day date{year{y}, month{unsigned(m)}, std::chrono::day{unsigned(d)}};
  if (!date.ok()) return {};
  return sys_days{date}.time_since_epoch().count();
}

namespace {

std::string field(const std::string& text) {
  std::string out;
  if (!text.empty() && std::string_view("=+-@\t\r").find(text[0]) != std::string_view::npos)
    out += '\'';
  for (char c : text) {
    if (c == '"') out += c;
    out += c;
  }
  if (text.find_first_of("\",\r\n") == std::string::npos) return out;
  return fmt::format("\"{}\"", out);
}

}  // namespace

std::string write_csv(const Sums& sums) {
  std::string out = "day,what,key,value\r\n";
  for (const auto& [key, value] : sums)
    out += fmt::format("{},{},{},{}\r\n", day_text(key.day), field(key.what), field(key.key),
                       std::round(10 * value) / 10);
  return out;
}

namespace {

namespace fs = std::filesystem;

struct FileError : std::runtime_error {
  int code;
  FileError(const std::string& file, int wrong, const std::string& what)
      : std::runtime_error(file + ": " + what), code(wrong & 0xff) {}
};

class Database {
 public:
  Database(const std::string& file, bool writes, int patience) : file_(file) {
    const int way = writes ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY;
    sqlite3* database = nullptr;
    const int result = sqlite3_open_v2(file.c_str(), &database, way, nullptr);
    database_.reset(database);
    if (result != SQLITE_OK) fail(result);
    sqlite3_busy_timeout(database, patience);
  }
  void run(const char* orders) {
    const int result = sqlite3_exec(database_.get(), orders, nullptr, nullptr, nullptr);
    if (result != SQLITE_OK) fail(result);
  }
  [[noreturn]] void fail(int result) const {
    throw FileError(file_, result,
                    database_ ? sqlite3_errmsg(database_.get()) : sqlite3_errstr(result));
  }
  sqlite3* get() const { return database_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  };
  std::string file_;
  std::unique_ptr<sqlite3, Close> database_;
};

class Statement {
 public:
  Statement(const Database& database, const char* text) : database_(database) {
    const int result = sqlite3_prepare_v2(database.get(), text, -1, &statement_, nullptr);
    if (result != SQLITE_OK) database.fail(result);
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;
  void bind(int place, const std::string& text) {
    sqlite3_bind_text(statement_, place, text.data(), int(text.size()), SQLITE_TRANSIENT);
  }
  void bind(int place, double value) { sqlite3_bind_double(statement_, place, value); }
  bool step() {  // true: there is a row
    const int result = sqlite3_step(statement_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) database_.fail(result);
    return result == SQLITE_ROW;
  }
  void reset() { sqlite3_reset(statement_); }
  std::string text(int column) const {
    const auto* bytes = sqlite3_column_text(statement_, column);
    return bytes ? reinterpret_cast<const char*>(bytes) : "";
  }
  double number(int column) const { return sqlite3_column_double(statement_, column); }

 private:
  const Database& database_;
  sqlite3_stmt* statement_ = nullptr;
};

void add_rows(const std::string& file, const Sums& sums, int patience) {
  Database database(file, true, patience);
  database.run("BEGIN IMMEDIATE;");
  database.run(
      "CREATE TABLE IF NOT EXISTS sums (day TEXT NOT NULL, what TEXT NOT NULL, key TEXT NOT NULL,"
      " value REAL NOT NULL, PRIMARY KEY (day, what, key)) WITHOUT ROWID");
  Statement row(database,
                "INSERT INTO sums VALUES (?, ?, ?, ?) ON CONFLICT (day, what, key)"
                " DO UPDATE SET value = value + excluded.value");
  for (const auto& [key, value] : sums) {
    row.bind(1, day_text(key.day));
    row.bind(2, key.what);
    row.bind(3, key.key);
    row.bind(4, value);
    row.step();
    row.reset();
  }
  database.run("COMMIT");
}

bool is_damage(const FileError& error) {
  return error.code == SQLITE_CORRUPT || error.code == SQLITE_NOTADB;
}

// Returns whether the file is undamaged: another server may have begun it anew meanwhile.
bool is_whole(const std::string& file, int patience) {
  try {
    Database database(file, false, patience);
    Statement check(database, "PRAGMA quick_check(1)");
    return check.step() && check.text(0) == "ok";
  } catch (const FileError& error) {
    return !is_damage(error);
  }
}

void put_aside(const std::string& file) {
  char when[32];
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::strftime(when, sizeof when, ".damaged-%Y%m%d-%H%M%S", &local);
  const std::string aside = file + when;
  fs::rename(file, aside);
  std::error_code error;  // ignored: these files may be missing
  for (const char* end : {"-wal", "-shm"}) fs::rename(file + end, aside + end, error);
  log::warn("{}: is damaged; it is now {}, and sums begin anew", file, aside);
}

}  // namespace

void add_to_file(const std::string& file, const Sums& sums, int patience) {
  const fs::path folder = fs::path(file).parent_path();
  if (!folder.empty()) fs::create_directories(folder);
  try {
    add_rows(file, sums, patience);
  } catch (const FileError& error) {
    if (!is_damage(error)) throw;
    if (!is_whole(file, patience)) put_aside(file);
    add_rows(file, sums, patience);
  }
}

Sums read_from_file(const std::string& file, int64_t from, int64_t to, int patience) {
  Sums sums;
  if (!fs::exists(file)) return sums;
  Database database(file, false, patience);
  Statement is_there(database, "SELECT 1 FROM sqlite_master WHERE name = 'sums'");
  if (!is_there.step()) return sums;
  Statement rows(database, "SELECT day, what, key, value FROM sums WHERE day >= ? AND day <= ?");
  rows.bind(1, day_text(from));
  rows.bind(2, day_text(to));
  while (rows.step())
    if (auto day = parse_day(rows.text(0)))
      sums[{*day, rows.text(1), rows.text(2)}] += rows.number(3);
  return sums;
}

}  // namespace wellspring::ledger
