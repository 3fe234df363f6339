#include "protocol/bag/Reader.h"

#include "protocol/bag/Db3.h"
#include "protocol/bag/McapBag.h"
#include "protocol/bag/Ros1Bag.h"
#include "protocol/bag/SplitBag.h"
#include "protocol/bag/Zstd.h"

#include <algorithm>
#include <filesystem>

namespace hermes::bag {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view sqliteMagic("SQLite format 3\0", 16);

/// Of a file that was packed as a whole: reads the other, which goes with this.
class PackedBag : public Reader {
public:
    PackedBag(UnpackedFile file, std::unique_ptr<Reader> reader)
        : file_(std::move(file))
        , reader_(std::move(reader)) {}

    std::string kind() const override { return reader_->kind() + ", packed by zstd"; }
    const std::vector<Topic> &topics() const override { return reader_->topics(); }
    std::uint64_t start_ns() const override { return reader_->start_ns(); }
    std::uint64_t end_ns() const override { return reader_->end_ns(); }
    void select(const std::function<bool(const Topic &)> &wanted) override { reader_->select(wanted); }
    std::optional<Message> next() override { return reader_->next(); }
    std::string problem() const override { return reader_->problem(); }

private:
    UnpackedFile file_;
    std::unique_ptr<Reader> reader_; ///< goes first
};

std::string beginOf(mcap::File &file) {
    std::string begin;
    file.read(0, std::min<std::uint64_t>(file.size(), sqliteMagic.size()), begin);
    return begin;
}

Outcome<std::unique_ptr<Reader>> openPlain(const std::string &path, const std::string &begin,
                                           mcap::File file) {
    if (Ros1Bag::isOne(begin))
        return Ros1Bag::open(std::move(file));
    if (begin == sqliteMagic)
        return openDb3(path);
    if (begin.substr(0, mcap::magic.size()) == mcap::magic)
        return openMcap(path);
    return path + ": found " + (begin.empty() ? "an empty file" : "another file") +
           ", expected a bag: it begins with #ROSBAG V2.0, SQLite format 3 or the magic of MCAP";
}

/// The message with the name of the file that the caller knows.
Outcome<std::unique_ptr<Reader>> openPacked(const std::string &path) {
    auto unpacked = UnpackedFile::of(path);
    if (!unpacked)
        return unpacked.error();
    const std::string name = unpacked->path();
    auto file = mcap::File::open(name);
    if (!file)
        return file.error();
    const std::string begin = beginOf(*file);
    auto reader = openPlain(name, begin, file.take());
    if (!reader)
        return reader.error().rfind(name, 0) == 0 ? path + " (unpacked)" + reader.error().substr(name.size())
                                                  : reader.error();
    return std::unique_ptr<Reader>(std::make_unique<PackedBag>(unpacked.take(), reader.take()));
}

} // namespace

Outcome<std::unique_ptr<Reader>> open(const std::string &path) {
    std::error_code ignored;
    if (fs::is_directory(fs::u8path(path), ignored))
        return isBagFolder(path)
                   ? openFolder(path)
                   : path + ": found a folder without metadata.yaml or *.db3, expected a bag of ROS 2";
    auto file = mcap::File::open(path);
    if (!file)
        return file.error();
    const std::string begin = beginOf(*file);
    return isZstd(begin) ? openPacked(path) : openPlain(path, begin, file.take());
}

bool isBag(const std::string &path) {
    std::error_code ignored;
    const fs::path name = fs::u8path(path);
    if (fs::is_directory(name, ignored))
        return isBagFolder(path);
    if (!fs::is_regular_file(name, ignored))
        return false; // a pipe can be read only once
    for (const std::string end : {".bag", ".bag.active", ".db3", ".mcap", ".db3.zstd", ".mcap.zstd"})
        if (path.size() > end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0)
            return true;
    auto file = mcap::File::open(path);
    const std::string begin = file ? beginOf(*file) : std::string();
    return Ros1Bag::isOne(begin) || begin == sqliteMagic ||
           begin.substr(0, mcap::magic.size()) == mcap::magic;
}

std::string plainType(std::string type) {
    if (const std::size_t at = type.find("/msg/"); at != std::string::npos)
        type.erase(at, 4);
    return type;
}

} // namespace hermes::bag
