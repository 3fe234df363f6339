#include "protocol/mcap/Scan.h"

#include <algorithm>
#include <zlib.h>

namespace hermes::mcap {

namespace {

// Schemas and channels of a file, in bytes: a chunk of a few bytes may be unpacked to many.
constexpr std::uint64_t mostDefinitions = 16 << 20;
constexpr std::uint64_t largestSummary = 256 << 20;

class Scan {
public:
    Scan(File &file, Problems &problems)
        : file_(file)
        , problems_(problems) {}

    bool begin();
    void readEnd();
    void readAll();
    Found &found() { return found_; }

private:
    bool takeSummary(std::string_view records);
    bool takeStatistics(std::string_view content);
    bool areChunksDisjoint(std::uint64_t end);
    bool define(const Record &record);
    bool takeNext(std::uint64_t &offset);
    void accept(std::uint64_t end);
    void takeChunk(std::uint64_t &offset, std::uint64_t bytes);
    void takeMessages(std::string_view records, Chunk &chunk, std::map<std::uint16_t, std::string> &entries);

    File &file_;
    Problems &problems_;
    Found found_;
    std::uint64_t definitions_ = 0;
};

bool Scan::begin() {
    std::string head;
    if (!file_.read(0, magic.size() + headBytes, head) || head.compare(0, magic.size(), magic) != 0)
        return false;
    Fields header(std::string_view(head).substr(magic.size()));
    const auto op = Op(header.number<std::uint8_t>());
    return op == Op::Header && header.number<std::uint64_t>() <= file_.size() - head.size();
}

/// By footer and summary; found_.whole tells whether they are there.
void Scan::readEnd() {
    std::string end, summary;
    const std::uint64_t endBytes = footerBytes + magic.size();
    if (file_.size() < magic.size() + endBytes)
        return;
    const std::uint64_t footerAt = file_.size() - endBytes;
    if (!file_.read(footerAt, endBytes, end) || end.compare(footerBytes, magic.size(), magic) != 0)
        return;
    Fields fields(end);
    const auto footer = takeRecord(fields);
    if (!footer || footer->op != Op::Footer || footer->content.size() != footerBytes - headBytes)
        return;
    Fields places(footer->content);
    const auto begin = places.number<std::uint64_t>();
    places.number<std::uint64_t>(); // where the offsets begin
    const auto sum = places.number<std::uint32_t>();
    if (begin == 0) {
        found_.whole = true;
        return;
    }
    if (begin > footerAt || footerAt - begin > largestSummary ||
        !file_.read(begin, footerAt - begin, summary))
        return problems_.add(footerAt, "the summary is not where the footer tells");
    const auto crc = [](uLong before, std::string_view bytes) {
        return crc32(before, reinterpret_cast<const Bytef *>(bytes.data()), uInt(bytes.size()));
    };
    if (sum != 0 && sum != crc(crc(0, summary), std::string_view(end).substr(0, footerBytes - 4)))
        return problems_.add(begin, "the sum of the summary is wrong");
    found_.whole = takeSummary(summary) && areChunksDisjoint(begin);
    if (!found_.whole)
        problems_.add(begin, "the summary is damaged");
}

bool Scan::takeSummary(std::string_view records) {
    Fields left(records);
    while (const auto record = takeRecord(left)) {
        if (record->op == Op::Schema || record->op == Op::Channel) {
            if (!define(*record))
                return false;
        } else if (record->op == Op::Statistics) {
            if (!takeStatistics(record->content))
                return false;
        } else if (record->op == Op::ChunkIndex) {
            auto chunk = toChunk(record->content);
            if (!chunk)
                return false;
            found_.contents.add(std::move(*chunk));
        }
    }
    return left.ok();
}

bool Scan::takeStatistics(std::string_view content) {
    Fields fields(content);
    fields.bytes(8 + 2 + 4 * 4 + 8 + 8); // all but the map can be counted
    Fields counts(fields.text());
    while (!counts.left().empty()) {
        const auto channel = counts.number<std::uint16_t>();
        found_.contents.counts[channel] = counts.number<std::uint64_t>();
    }
    return fields.ok() && counts.ok();
}

/// So that no bytes of the file are unpacked more than once.
bool Scan::areChunksDisjoint(std::uint64_t end) {
    auto &chunks = found_.contents.chunks;
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

/// The first of an id counts.
bool Scan::define(const Record &record) {
    auto &[schemas, channels, counts, chunks, start, end] = found_.contents;
    definitions_ += record.content.size();
    if (definitions_ > mostDefinitions)
        return false;
    if (record.op == Op::Schema) {
        auto schema = toSchema(record.content);
        return schema && (schemas.emplace(schema->id, std::move(*schema)), true);
    }
    auto channel = toChannel(record.content);
    return channel && (channels.emplace(channel->id, std::move(*channel)), true);
}

void Scan::readAll() {
    found_.contents = {};
    definitions_ = 0;
    std::uint64_t offset = magic.size();
    while (takeNext(offset)) {
    }
    if (!found_.whole && found_.cut < file_.size())
        problems_.add(found_.cut, "no whole record follows; " + std::to_string(file_.size() - found_.cut) +
                                      " bytes are lost");
}

/// false: the data end, in order or not.
bool Scan::takeNext(std::uint64_t &offset) {
    std::string record;
    if (!file_.read(offset, headBytes, record))
        return false;
    Fields head(record);
    const auto op = Op(head.number<std::uint8_t>());
    const auto length = head.number<std::uint64_t>();
    const std::uint64_t left = file_.size() - offset - headBytes;
    if (op == Op(0) || op == Op::DataEnd || op == Op::Footer || length > left)
        return false;
    if (op == Op::Chunk) {
        takeChunk(offset, headBytes + length);
        return true;
    }
    const std::uint64_t at = offset;
    offset += headBytes + length;
    if (op == Op::MessageIndex)
        return true; // of a chunk that is damaged
    if (op == Op::Message)
        problems_.add(at, "a message outside of a chunk");
    if (op == Op::Schema || op == Op::Channel) {
        const bool isRead = length <= mostDefinitions && file_.read(at + headBytes, length, record);
        if (!isRead || !define({op, record}))
            problems_.add(at, "the schema or channel is damaged");
    }
    accept(offset);
    return true;
}

/// What ends there stays in a file that is mended.
void Scan::accept(std::uint64_t end) {
    if (!found_.indexes.empty()) { // they cannot be put between records any more
        found_.contents.chunks.back().indexes.clear();
        found_.contents.chunks.back().indexBytes = 0;
        found_.indexes.clear();
    }
    found_.cut = end;
}

void Scan::takeChunk(std::uint64_t &offset, std::uint64_t bytes) {
    Chunk chunk;
    chunk.offset = offset;
    chunk.bytes = bytes;
    offset += bytes;
    std::string records;
    if (const auto loaded = loadChunk(file_, chunk, records); !loaded)
        return problems_.add(chunk.offset, loaded.error());
    std::map<std::uint16_t, std::string> entries;
    takeMessages(records, chunk, entries);
    accept(offset);
    if (entries.empty())
        return;
    std::string there;
    putIndexes(found_.indexes, entries, offset, chunk);
    if (file_.read(offset, chunk.indexBytes, there) && there == found_.indexes) {
        found_.indexes.clear();
        found_.cut = offset += chunk.indexBytes;
    }
    found_.contents.add(std::move(chunk));
}

void Scan::takeMessages(std::string_view records, Chunk &chunk,
                        std::map<std::uint16_t, std::string> &entries) {
    Fields left(records);
    bool isSound = true;
    for (std::uint64_t at = 0; const auto record = takeRecord(left);
         at = records.size() - left.left().size()) {
        if (record->op == Op::Schema || record->op == Op::Channel)
            isSound = define(*record) && isSound;
        if (record->op != Op::Message)
            continue;
        const auto message = toMessage(record->content);
        if (!message || found_.contents.channels.count(message->channel) == 0) {
            isSound = false;
            continue;
        }
        const std::uint64_t time_ns = message->logTime_ns;
        chunk.start_ns = entries.empty() ? time_ns : std::min(chunk.start_ns, time_ns);
        chunk.end_ns = entries.empty() ? time_ns : std::max(chunk.end_ns, time_ns);
        std::string &entry = entries[message->channel];
        putNumber(entry, time_ns);
        putNumber(entry, at);
        ++found_.contents.counts[message->channel];
    }
    if (!isSound || !left.ok())
        problems_.add(chunk.offset, "the chunk has damaged records, or some of no known channel");
}

} // namespace

Outcome<Found> readContents(File &file, Problems &problems) {
    Scan scan(file, problems);
    if (!scan.begin())
        return file.path() + ": found no header, expected an MCAP file";
    scan.readEnd();
    if (!scan.found().whole || scan.found().contents.chunks.empty())
        scan.readAll();
    return std::move(scan.found());
}

} // namespace hermes::mcap
