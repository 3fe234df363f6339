#include "protocol/bag/SplitBag.h"

#include "protocol/bag/Metadata.h"
#include "protocol/bag/TopicList.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>

namespace hermes::bag {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t mostOpenParts = 16;
constexpr std::uint64_t largestMetadata = 16 << 20;

class SplitBag : public Reader {
public:
    /// Gives why it cannot be read; empty: it can.
    std::string add(const std::string &path);
    void finish();
    bool isEmpty() const { return parts_.empty(); }
    void note(const std::string &what) {
        if (problems_++ == 0)
            first_ = what;
    }

    std::string kind() const override {
        return kind_ + (parts_.size() > 1 ? ", " + std::to_string(parts_.size()) + " files" : "");
    }
    const std::vector<Topic> &topics() const override { return topics_.all(); }
    std::uint64_t start_ns() const override { return start_ns_; }
    std::uint64_t end_ns() const override { return end_ns_; }
    void select(const std::function<bool(const Topic &)> &wanted) override;
    std::optional<Message> next() override;
    std::string problem() const override {
        return problems_ < 2 ? first_ : first_ + " (and " + std::to_string(problems_ - 1) + " more)";
    }

private:
    struct Part {
        std::string path;
        std::uint64_t start_ns = 0;
        std::vector<std::size_t> places; ///< of its topics among those of all
    };
    struct Open {
        const Part *part = nullptr;
        std::unique_ptr<Reader> reader;
        std::optional<Message> message; ///< the next one

        std::uint64_t time_ns() const {
            return message ? message->time_ns : std::numeric_limits<std::uint64_t>::max();
        }
    };
    void advance(std::size_t i);
    void openParts();

    std::vector<Part> parts_; ///< in the order of their first messages
    std::string kind_;
    TopicList topics_;
    std::uint64_t start_ns_ = 0, end_ns_ = 0;
    std::vector<bool> isWanted_; ///< of each topic; empty: all
    std::size_t nextPart_ = 0;
    std::vector<Open> open_;
    std::optional<std::size_t> given_; ///< which of them gave the last message
    std::string first_;
    std::uint64_t problems_ = 0;
};

std::string SplitBag::add(const std::string &path) {
    auto reader = open(path);
    if (!reader)
        return reader.error();
    Part part{path, (*reader)->start_ns(), {}};
    for (const Topic &topic : (*reader)->topics())
        part.places.push_back(topics_.add(topic));
    if ((*reader)->end_ns() > 0) {
        start_ns_ = start_ns_ == 0 ? part.start_ns : std::min(start_ns_, part.start_ns);
        end_ns_ = std::max(end_ns_, (*reader)->end_ns());
    }
    kind_ = (*reader)->kind();
    parts_.push_back(std::move(part));
    return {};
}

void SplitBag::finish() {
    std::stable_sort(parts_.begin(), parts_.end(),
                     [](const Part &a, const Part &b) { return a.start_ns < b.start_ns; });
}

void SplitBag::select(const std::function<bool(const Topic &)> &wanted) {
    isWanted_.clear();
    for (const Topic &topic : topics())
        isWanted_.push_back(wanted(topic));
    open_.clear();
    given_.reset();
    nextPart_ = 0;
}

std::optional<Message> SplitBag::next() {
    if (given_)
        advance(*given_);
    given_.reset();
    openParts();
    if (open_.empty())
        return std::nullopt;
    const auto first = std::min_element(
        open_.begin(), open_.end(), [](const Open &a, const Open &b) { return a.time_ns() < b.time_ns(); });
    given_ = std::size_t(first - open_.begin());
    Message message = *first->message;
    message.topic = first->part->places[message.topic];
    return message;
}

/// To the next message of an open part; at its end the part is closed.
void SplitBag::advance(std::size_t i) {
    open_[i].message = open_[i].reader->next();
    if (open_[i].message)
        return;
    if (const std::string why = open_[i].reader->problem(); !why.empty())
        note(open_[i].part->path + ": " + why);
    open_.erase(open_.begin() + std::ptrdiff_t(i));
}

/// Until none begins before what comes next.
void SplitBag::openParts() {
    for (; nextPart_ < parts_.size(); ++nextPart_) {
        const Part &part = parts_[nextPart_];
        if (std::any_of(open_.begin(), open_.end(),
                        [&](const Open &o) { return o.time_ns() < part.start_ns; }))
            return;
        if (open_.size() == mostOpenParts) {
            note(part.path + ": too many files overlap: messages may come out of order");
            return;
        }
        auto reader = open(part.path);
        if (!reader || (*reader)->topics().size() != part.places.size()) {
            note(reader ? part.path + ": was changed while it was read" : reader.error());
            continue;
        }
        Open opened{&part, reader.take(), {}};
        if (!isWanted_.empty()) {
            const Topic *const topics = opened.reader->topics().data();
            opened.reader->select([&](const Topic &topic) {
                return bool(isWanted_[part.places[std::size_t(&topic - topics)]]);
            });
        }
        open_.push_back(std::move(opened));
        advance(open_.size() - 1);
    }
}

std::string textOf(const fs::path &path) {
    std::error_code error;
    if (fs::file_size(path, error) > largestMetadata || error)
        return {};
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Whether a name is that of a database, packed or not.
bool isDatabase(const std::string &name) {
    for (const std::string end : {".db3", ".db3.zstd"})
        if (name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0)
            return true;
    return false;
}

std::vector<std::string> databasesIn(const fs::path &folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator file(folder, error), end; !error && file != end; file.increment(error))
        if (const std::string name = file->path().filename().u8string(); isDatabase(name))
            names.push_back(name);
    std::sort(names.begin(), names.end());
    return names;
}

} // namespace

bool isBagFolder(const std::string &folder) {
    const fs::path path = fs::u8path(folder);
    return readMetadata(textOf(path / "metadata.yaml")).isBag || !databasesIn(path).empty();
}

Outcome<std::unique_ptr<Reader>> openFolder(const std::string &folder) {
    const fs::path path = fs::u8path(folder);
    Metadata metadata = readMetadata(textOf(path / "metadata.yaml"));
    if (!metadata.compression.empty() && metadata.compression != "zstd")
        return folder + ": metadata.yaml: found compression_format " + metadata.compression.substr(0, 80) +
               ", expected zstd or none";
    auto bag = std::make_unique<SplitBag>();
    if (metadata.files.empty())
        metadata.files = databasesIn(path);
    std::string why;
    for (const std::string &name : metadata.files) {
        std::error_code ignored;
        fs::path file = path / fs::u8path(name);
        if (!fs::exists(file, ignored))
            file = path / fs::u8path(name + ".zstd");
        const bool isFile = fs::is_regular_file(file, ignored); // else a folder could name itself
        why = isFile ? bag->add(file.u8string())
                     : (path / fs::u8path(name)).u8string() + ": there is no such file";
        if (!why.empty())
            bag->note(why);
    }
    if (bag->isEmpty())
        return metadata.files.empty() ? folder + ": metadata.yaml names no file, and there is no *.db3" : why;
    bag->finish();
    return std::unique_ptr<Reader>(std::move(bag));
}

} // namespace hermes::bag
