#pragma once
// SQLite behind an interface of the few things that a sweep needs.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace hwsim::lab {

/// Throws InputError U021 with SQLite's reason, from every function.
class Database {
 public:
  enum class Mode {
    create,  ///< the file is made when there is none
    write,
    look,            ///< the file and its folder may be read-only; nothing is written
    look_as_it_lies  ///< the same of the file alone, without what lies beside it
  };
  /// `shown`: the name in messages, where it is another one.
  Database(const std::string& path, Mode mode, const std::string& shown = {});

  void execute(const std::string& sql);
  bool try_execute(const std::string& sql);  ///< false where it failed, without an error

  class Statement {
   public:
    Statement(Database& database, std::string_view sql);
    Statement& bind(int place, std::string_view text);  ///< places count from 1
    Statement& bind(int place, double value);
    Statement& bind(int place, std::int64_t value);
    Statement& bind_null(int place);
    Statement& bind(int place, const Statement& row, int column);  ///< a value of another statement's row
    bool step();                                                   ///< true: there is a row
    void run();    ///< a statement without rows; ready to be bound again
    void reset();  ///< ready to be bound again
    std::string text(int column) const;
    std::int64_t integer(int column) const;
    std::optional<double> real(int column) const;  ///< none: NULL
    bool is_number(int column) const;              ///< before text(), which may change the stored type

   private:
    Database& database_;
    std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> handle_;
  };

  /// Committed at the end, or nothing of it is there.
  class Transaction {
   public:
    explicit Transaction(Database& database);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

   private:
    Database& database_;
    bool open_ = true;
  };

 private:
  [[noreturn]] void fail() const;
  void require(int code) const;

  std::string path_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> handle_;
};

}  // namespace hwsim::lab
