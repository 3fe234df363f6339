#include "protocol/bag/Db3.h"

#ifdef HERMES_SQLITE

#include "protocol/bag/Zstd.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <sqlite3.h>

namespace hermes::bag {

namespace {

constexpr std::size_t mostTopics = 1 << 14;
constexpr int largestText = 16 << 20; // of a definition

std::string columnText(sqlite3_stmt *row, int column) {
    const auto *text = reinterpret_cast<const char *>(sqlite3_column_text(row, column));
    return text == nullptr ? std::string()
                           : std::string(text, std::size_t(sqlite3_column_bytes(row, column)));
}

/// A name in a URI of SQLite.
std::string uriOf(const std::string &path, bool isImmutable) {
    std::string uri = "file:";
    const std::size_t slashes = std::min(path.find_first_not_of('/'), path.size()); // "//" would begin a host
    for (const char c : path.substr(slashes - std::min<std::size_t>(slashes, 1))) {
        const bool isPlain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                             c == '/' || c == '.' || c == '-' || c == '_';
        const char *const digits = "0123456789ABCDEF";
        if (isPlain)
            uri += c;
        else
            (uri += '%', uri += digits[static_cast<unsigned char>(c) >> 4], uri += digits[c & 15]);
    }
    return uri + (isImmutable ? "?immutable=1" : "?mode=ro");
}

class Db3 : public Reader {
public:
    explicit Db3(std::string path)
        : path_(std::move(path)) {}

    /// Gives why that fails; empty: it is done.
    std::string open();

    std::string kind() const override { return "bag of ROS 2, SQLite"; }
    const std::vector<Topic> &topics() const override { return topics_; }
    std::uint64_t start_ns() const override { return start_ns_; }
    std::uint64_t end_ns() const override { return end_ns_; }
    void select(const std::function<bool(const Topic &)> &wanted) override;
    std::optional<Message> next() override;
    std::string problem() const override;

private:
    struct Close {
        void operator()(sqlite3 *database) const { sqlite3_close(database); }
        void operator()(sqlite3_stmt *statement) const { sqlite3_finalize(statement); }
    };
    using Statement = std::unique_ptr<sqlite3_stmt, Close>;

    Statement prepare(const std::string &query);
    bool isTable(const char *name);
    bool readTopics();
    void readDefinitions();
    void readSpan();
    bool addSpans(const std::string &query);
    void note(const std::string &what);
    void noteError(const std::string &where) { note(where + ": " + sqlite3_errmsg(database_.get())); }
    void begin(const std::string &how, const std::string &order);
    bool takeData(std::int64_t id, Message &message);

    std::string path_;
    std::unique_ptr<sqlite3, Close> database_;
    std::vector<Topic> topics_;
    std::map<std::int64_t, std::size_t> places_; ///< among the topics, by id
    std::uint64_t start_ns_ = 0, end_ns_ = 0;
    std::string ids_; ///< of wanted topics
    Statement order_, data_;
    bool isAtEnd_ = false, isUnordered_ = false;
    std::optional<std::int64_t> last_; ///< id of the last message
    std::string unpacked_;
    std::string first_; ///< problem
    std::uint64_t problems_ = 0;
};

std::string Db3::open() {
    std::error_code error;
    const auto journal = std::filesystem::u8path(path_ + "-wal");
    // Else SQLite wants to write beside the database.
    const bool isImmutable = !(std::filesystem::file_size(journal, error) > 0) || error;
    sqlite3 *opened = nullptr;
    const int code = sqlite3_open_v2(uriOf(path_, isImmutable).c_str(), &opened,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
    database_.reset(opened);
    if (code != SQLITE_OK)
        return std::string("cannot be opened: ") + sqlite3_errstr(code);
    sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, int(mcap::largestChunk));
    // Of a database that is only read this lets a file be read that was cut off.
    sqlite3_db_config(opened, SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_exec(opened, "PRAGMA cell_size_check=ON; PRAGMA mmap_size=0", nullptr, nullptr, nullptr);
    const std::string hint =
        isImmutable ? ""
                    : " (SQLite reads what is in its write-ahead log only in a folder that can be written)";
    for (const char *const name : {"topics", "messages"})
        if (!isTable(name))
            return first_.empty() ? std::string("found no table ") + name + ", expected a bag of ROS 2"
                                  : first_ + hint;
    if (!readTopics())
        return first_ + hint;
    readDefinitions();
    readSpan();
    select([](const Topic &) { return true; });
    return {};
}

Db3::Statement Db3::prepare(const std::string &query) {
    sqlite3_stmt *statement = nullptr;
    sqlite3_prepare_v2(database_.get(), query.c_str(), int(query.size()), &statement, nullptr);
    return Statement(statement);
}

/// And no view or virtual table, which might never end.
bool Db3::isTable(const char *name) {
    const Statement found = prepare(
        std::string("SELECT 1 FROM sqlite_master WHERE type = 'table' AND rootpage > 0 AND name = '") + name +
        "'");
    const int code = found ? sqlite3_step(found.get()) : SQLITE_ERROR;
    if (code != SQLITE_ROW && code != SQLITE_DONE)
        noteError("the list of tables");
    return code == SQLITE_ROW;
}

bool Db3::readTopics() {
    const Statement rows = prepare("SELECT id, name, type, serialization_format FROM topics");
    int code = SQLITE_ERROR;
    while (rows && (code = sqlite3_step(rows.get())) == SQLITE_ROW && topics_.size() < mostTopics) {
        places_.emplace(sqlite3_column_int64(rows.get(), 0), topics_.size());
        topics_.push_back({columnText(rows.get(), 1), plainType(columnText(rows.get(), 2)), "",
                           columnText(rows.get(), 3), 0});
    }
    if (code == SQLITE_ROW)
        note("table topics: found more than " + std::to_string(mostTopics) + " topics");
    else if (code != SQLITE_DONE)
        noteError("table topics");
    return !topics_.empty() || code == SQLITE_DONE;
}

/// Of newer bags.
void Db3::readDefinitions() {
    if (!isTable("message_definitions"))
        return;
    const Statement rows =
        prepare("SELECT topic_type, encoded_message_definition FROM message_definitions WHERE "
                "encoding = 'ros2msg' AND "
                "length(encoded_message_definition) < " +
                std::to_string(largestText) + " LIMIT " + std::to_string(mostTopics));
    std::size_t bytes = 0;
    while (rows && sqlite3_step(rows.get()) == SQLITE_ROW && bytes < std::size_t(largestText)) {
        const std::string type = plainType(columnText(rows.get(), 0)), text = columnText(rows.get(), 1);
        for (Topic &topic : topics_)
            if (topic.type == type && topic.definition.empty() && bytes < std::size_t(largestText)) {
                topic.definition = text;
                bytes += text.size();
            }
    }
}

/// Counts, and the first and last time.
void Db3::readSpan() {
    const std::string rows = "SELECT topic_id, COUNT(*), MIN(timestamp), MAX(timestamp) FROM messages ";
    if (addSpans(rows + "GROUP BY topic_id"))
        return;
    for (Topic &topic : topics_)
        topic.messages = 0;
    start_ns_ = end_ns_ = 0;
    addSpans("SELECT topic_id, 1, timestamp, timestamp FROM messages NOT INDEXED"); // those that can be read
}

bool Db3::addSpans(const std::string &query) {
    const Statement rows = prepare(query);
    int code = SQLITE_ERROR;
    while (rows && (code = sqlite3_step(rows.get())) == SQLITE_ROW) {
        const auto number = [&](int column) {
            return std::uint64_t(sqlite3_column_int64(rows.get(), column));
        };
        const auto place = places_.find(std::int64_t(number(0)));
        if (place == places_.end()) {
            note("table messages: found one or more of topic " + std::to_string(number(0)) +
                 ", expected the id of a row of table topics");
            continue;
        }
        topics_[place->second].messages += number(1);
        start_ns_ = end_ns_ == 0 ? number(2) : std::min(start_ns_, number(2));
        end_ns_ = std::max(end_ns_, number(3));
    }
    if (code != SQLITE_DONE)
        noteError("table messages");
    return code == SQLITE_DONE;
}

void Db3::select(const std::function<bool(const Topic &)> &wanted) {
    ids_.clear();
    for (const auto &[id, place] : places_)
        if (wanted(topics_[place]))
            ids_ += (ids_.empty() ? "" : ",") + std::to_string(id);
    begin("", "timestamp, rowid");
}

void Db3::begin(const std::string &how, const std::string &order) {
    last_.reset();
    order_ = prepare("SELECT rowid, topic_id, timestamp FROM messages " + how + " WHERE topic_id IN (" +
                     ids_ + ") ORDER BY " + order);
    data_ = prepare("SELECT data FROM messages WHERE rowid = ?");
    isAtEnd_ = !order_ || !data_;
    if (isAtEnd_)
        noteError("table messages");
}

std::optional<Message> Db3::next() {
    while (!isAtEnd_) {
        if (const int code = sqlite3_step(order_.get()); code != SQLITE_ROW) {
            isAtEnd_ = true;
            if (code == SQLITE_DONE)
                break;
            noteError("table messages, " +
                      (last_ ? "behind id " + std::to_string(*last_) : "before the first"));
            if (!last_ && !isUnordered_) { // what sorts them reads all of them
                isUnordered_ = true;
                begin("NOT INDEXED", "rowid");
            }
            continue;
        }
        last_ = sqlite3_column_int64(order_.get(), 0);
        Message message;
        const auto place = places_.find(sqlite3_column_int64(order_.get(), 1));
        message.time_ns = std::uint64_t(sqlite3_column_int64(order_.get(), 2));
        if (place == places_.end() || !takeData(*last_, message))
            continue;
        message.topic = place->second;
        return message;
    }
    return std::nullopt;
}

/// false: it cannot be read, which is noted.
bool Db3::takeData(std::int64_t id, Message &message) {
    const std::string where = "table messages, id " + std::to_string(id);
    sqlite3_reset(data_.get());
    sqlite3_bind_int64(data_.get(), 1, id);
    if (sqlite3_step(data_.get()) != SQLITE_ROW) {
        noteError(where);
        return false;
    }
    const auto *bytes = static_cast<const char *>(sqlite3_column_blob(data_.get(), 0));
    message.data = {bytes, bytes == nullptr ? 0 : std::size_t(sqlite3_column_bytes(data_.get(), 0))};
    if (!isZstd(message.data)) // no CDR begins so
        return true;
    if (const std::string why = unpackMessage(message.data, unpacked_); !why.empty()) {
        note(where + ": " + why);
        return false;
    }
    message.data = unpacked_;
    return true;
}

void Db3::note(const std::string &what) {
    if (problems_++ == 0)
        first_ = what;
}

std::string Db3::problem() const {
    return problems_ < 2 ? first_ : first_ + " (and " + std::to_string(problems_ - 1) + " more)";
}

} // namespace

Outcome<std::unique_ptr<Reader>> openDb3(const std::string &path) {
    auto bag = std::make_unique<Db3>(path);
    if (const std::string why = bag->open(); !why.empty())
        return path + ": " + why;
    return std::unique_ptr<Reader>(std::move(bag));
}

} // namespace hermes::bag

#else

namespace hermes::bag {

Outcome<std::unique_ptr<Reader>> openDb3(const std::string &path) {
    return path +
           ": found a bag of ROS 2 in SQLite, expected another: this program was built without libsqlite3";
}

} // namespace hermes::bag

#endif
