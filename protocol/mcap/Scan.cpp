#include "protocol/mcap/Scan.h"

#include "protocol/mcap/Records.h"

#include <algorithm>
#include <filesystem>

namespace hermes::mcap {

namespace {

constexpr std::uint64_t largestSummary = 256 << 20;
constexpr std::uint64_t largestHeader = 4096; // that may be cut off: a longer one is damaged

class Scan {
public:
    explicit Scan(File &file)
        : file_(file) {}

    bool isMcap();
    bool readEnd();
    void readAll();
    Found &found() { return found_; }

private:
    bool takeSummary(std::string_view records);
    bool areChunksDisjoint(std::uint64_t end);
    bool takeNext(std::uint64_t &offset);
    void takeChunk(std::uint64_t &offset, std::uint64_t bytes);
    void takeLoose(std::uint64_t at, std::uint64_t bytes);
    void accept(std::uint64_t end);

    File &file_;
    Found found_;
    Contents &contents_ = found_.contents;
};

/// Whether it begins like a file of MCAP, or was cut off before that could be seen.
bool Scan::isMcap() {
    std::string head;
    if (!file_.read(0, std::min<std::uint64_t>(file_.size(), magic.size() + headBytes), head) ||
        head.compare(0, magic.size(), magic.substr(0, head.size())) != 0)
        return false;
    std::uint8_t op = std::uint8_t(Op::Header);
    std::uint64_t length = 0;
    takeFields(std::string_view(head).substr(std::min(head.size(), magic.size())), op, length);
    return Op(op) == Op::Header && length <= std::max(file_.size() - head.size(), largestHeader);
}

/// By footer and summary. false: they are not there.
bool Scan::readEnd() {
    const std::uint64_t footerAt = file_.size() - footerBytes - magic.size(); // huge: the file is too short
    std::string end, summary;
    if (!file_.read(footerAt, footerBytes + magic.size(), end) ||
        end.compare(footerBytes, magic.size(), magic) != 0)
        return false;
    RecordCursor footer(end);
    std::uint64_t begin = 0, offsets = 0;
    std::uint32_t sum = 0;
    if (!footer.next() || footer.op != Op::Footer || footer.content.size() != footerBytes - headBytes ||
        !takeFields(footer.content, begin, offsets, sum))
        return false;
    if (begin == 0) // there is no summary
        return true;
    if (begin > footerAt || footerAt - begin > largestSummary ||
        !file_.read(begin, footerAt - begin, summary))
        return file_.note(footerAt, "the summary is not where the footer tells");
    if (sum != 0 && sum != sumOf(std::string_view(end).substr(0, footerBytes - 4), sumOf(summary)))
        return file_.note(begin, "the sum of the summary is wrong");
    return (takeSummary(summary) && areChunksDisjoint(begin)) || file_.note(begin, "the summary is damaged");
}

bool Scan::takeSummary(std::string_view records) {
    RecordCursor record(records);
    bool isSound = true;
    while (isSound && record.next()) {
        isSound = define(contents_, record.op, record.content);
        if (record.op == Op::Statistics) {
            const std::size_t countsAt = std::min<std::size_t>(record.content.size(), 8 + 2 + 4 * 4 + 8 + 8);
            isSound = takeFields(record.content.substr(countsAt), contents_.counts);
        } else if (record.op == Op::ChunkIndex) {
            Chunk chunk;
            isSound = take(record.content, chunk);
            contents_.add(std::move(chunk));
        }
    }
    return isSound && !record.isCut();
}

/// So that no bytes of the file are unpacked more than once.
bool Scan::areChunksDisjoint(std::uint64_t end) {
    auto &chunks = contents_.chunks;
    std::sort(chunks.begin(), chunks.end(),
              [](const Chunk &a, const Chunk &b) { return a.offset < b.offset; });
    std::uint64_t free = 0;
    for (const Chunk &chunk : chunks) {
        if (chunk.offset < free || chunk.offset > end || chunk.bytes > end - chunk.offset || chunk.bytes == 0)
            return false;
        free = chunk.offset + chunk.bytes;
    }
    return true;
}

void Scan::readAll() {
    contents_ = {};
    found_.missing = beginning("hermes");
    std::uint64_t offset = magic.size();
    while (takeNext(offset)) {
    }
    if (!found_.whole && (found_.bytes == 0 || found_.bytes < file_.size()))
        file_.note(found_.bytes, "no whole record follows; " + std::to_string(file_.size() - found_.bytes) +
                                     " bytes are lost");
}

/// false: the data end, in order or not.
bool Scan::takeNext(std::uint64_t &offset) {
    const std::uint64_t at = offset;
    std::string record;
    std::uint8_t first = 0;
    std::uint64_t length = 0;
    if (!file_.read(at, headBytes, record) || !takeFields(record, first, length))
        return false;
    const auto op = Op(first);
    if (op == Op(0) || op == Op::DataEnd || op == Op::Footer || length > file_.size() - at - headBytes)
        return false;
    offset += headBytes + length;
    if (op == Op::Chunk) {
        takeChunk(offset, headBytes + length);
    } else if (op != Op::MessageIndex) { // one here is of a chunk that is damaged
        const bool isDefinition = op == Op::Schema || op == Op::Channel;
        if (isDefinition && !(length <= mostDefinitions && file_.read(at + headBytes, length, record) &&
                              define(contents_, op, record)))
            file_.note(at, "the schema or channel is damaged");
        accept(offset);
        if (op == Op::Message)
            takeLoose(at, headBytes + length);
    }
    return true;
}

/// A message outside of chunks.
void Scan::takeLoose(std::uint64_t at, std::uint64_t bytes) {
    std::string fields;
    Message message;
    if (bytes > largestChunk)
        file_.note(at, "found a message of " + std::to_string(bytes) + " bytes, expected at most " +
                           std::to_string(largestChunk));
    else if (!file_.read(at + headBytes, std::min<std::uint64_t>(bytes, messageBytes) - headBytes, fields) ||
             !take(fields, message) || contents_.channels.count(message.channel) == 0)
        file_.note(at, "the message is damaged, or of no known channel");
    else
        contents_.addLoose(message, at, bytes);
}

/// offset: where the chunk ends; then, where its indexes end that are there.
void Scan::takeChunk(std::uint64_t &offset, std::uint64_t bytes) {
    IndexedChunk chunk;
    chunk.offset = offset - bytes;
    chunk.bytes = bytes;
    std::string records, there;
    if (!file_.load(chunk, records))
        return;
    RecordCursor record(records);
    bool isSound = true;
    while (record.next())
        isSound = define(contents_, record.op, record.content) && isSound;
    const auto add = [&](const Message &message, std::size_t at) { chunk.add(message, at); };
    if (!eachMessage(contents_, records, add) || !isSound)
        file_.note(chunk.offset, "the chunk has damaged records, or some of no known channel");
    accept(offset);
    if (chunk.entries.empty())
        return;
    found_.missing = chunk.indexesAt(offset);
    contents_.add(chunk);
    if (file_.read(offset, chunk.indexBytes, there) && there == found_.missing) {
        found_.missing.clear();
        accept(offset += chunk.indexBytes);
    }
}

/// What ends there stays in a file that is mended.
void Scan::accept(std::uint64_t end) {
    if (!found_.missing.empty() && !contents_.chunks.empty()) { // cannot be put between records any more
        contents_.chunks.back().indexes.clear();
        contents_.chunks.back().indexBytes = 0;
    }
    found_.missing.clear();
    found_.bytes = end;
}

} // namespace

Outcome<Found> readContents(File &file) {
    Scan scan(file);
    if (!scan.isMcap())
        return file.path() + ": found no header, expected an MCAP file";
    scan.found().whole = scan.readEnd();
    const Contents &contents = scan.found().contents;
    if (!scan.found().whole || contents.chunks.empty() || !contents.isAllIndexed())
        scan.readAll();
    if (scan.found().whole)
        scan.found().bytes = file.size();
    scan.found().problem = file.problem();
    return std::move(scan.found());
}

Outcome<Found> repair(const std::string &path) {
    auto file = File::open(path);
    if (!file)
        return file.error();
    auto found = readContents(*file);
    if (!found || found->whole)
        return found;
    const std::string end = found->missing + ending(found->contents, found->bytes + found->missing.size());
    const auto name = std::filesystem::u8path(path);
    std::error_code error;
    std::filesystem::resize_file(name, found->bytes, error);
    if (error)
        return path + ": cannot be cut: " + error.message();
    std::ofstream stream(name, std::ios::binary | std::ios::app);
    if (!stream.write(end.data(), std::streamsize(end.size())).flush())
        return path + ": its end cannot be written";
    found->bytes += end.size();
    return found;
}

} // namespace hermes::mcap
