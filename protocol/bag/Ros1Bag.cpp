#include "protocol/bag/Ros1Bag.h"

#include <algorithm>

namespace hermes::bag {

namespace {

constexpr std::string_view ros1Magic = "#ROSBAG V2.0\n";
constexpr std::string_view anyMagic = "#ROSBAG V";
constexpr std::uint64_t largestIndex = 256 << 20;
constexpr std::uint64_t largestRos1Loose = 1 << 20; // of messages outside of chunks that are read at once
constexpr std::size_t mostConnections = 1 << 16;

} // namespace

bool Ros1Bag::isOne(std::string_view begin) {
    return begin.substr(0, anyMagic.size()) == anyMagic;
}

Outcome<std::unique_ptr<Reader>> Ros1Bag::open(mcap::File file) {
    const std::string path = file.path();
    std::unique_ptr<Ros1Bag> bag(new Ros1Bag(std::move(file)));
    if (const std::string why = bag->readFileHeader(); !why.empty())
        return path + ": " + why;
    bag->isIndexed_ = bag->indexAt_ != 0 && bag->readIndex();
    if (!bag->isIndexed_)
        bag->scan();
    std::stable_sort(bag->chunks_.begin(), bag->chunks_.end(),
                     [](const Chunk &a, const Chunk &b) { return a.start_ns < b.start_ns; });
    for (const Chunk &chunk : bag->chunks_)
        for (const auto &[connection, count] : chunk.counts)
            if (const auto known = bag->connections_.find(connection); known != bag->connections_.end())
                bag->topics_.count(known->second, count);
    return std::unique_ptr<Reader>(std::move(bag));
}

std::string Ros1Bag::kind() const {
    return std::string("bag of ROS 1, version 2.0") + (isIndexed_ ? "" : ", read without its index");
}

/// Gives why the bag is refused; empty: it is not.
std::string Ros1Bag::readFileHeader() {
    std::string begin;
    file_.read(0, std::min<std::uint64_t>(file_.size(), ros1Magic.size()), begin);
    if (begin != ros1Magic)
        return "found " + begin.substr(0, begin.find('\n')) + ", expected #ROSBAG V2.0";
    Ros1Head head;
    if (!file_.readHead(ros1Magic.size(), head) || head.op != Ros1Op::FileHeader)
        return {}; // noted; what follows is looked at all the same
    if (!head.fields.text("encryptor").empty())
        return "byte 13: found a bag that is encrypted by " +
               std::string(head.fields.text("encryptor").substr(0, 80)) + ", expected one that is not";
    if (!head.fields.number("index_pos", indexAt_) || !head.fields.number("conn_count", connectionCount_) ||
        !head.fields.number("chunk_count", chunkCount_))
        file_.note(head.at, "the header of the bag does not tell where its index is and what it has");
    return {};
}

/// Connections and chunks as the end of the bag tells them. false: it does not.
bool Ros1Bag::readIndex() {
    std::string records;
    if (indexAt_ > file_.size() || file_.size() - indexAt_ > largestIndex ||
        !file_.read(indexAt_, file_.size() - indexAt_, records))
        return file_.note(indexAt_, "the index is not where the header of the bag tells: " +
                                        bytesText(file_.size()) + " are there");
    Ros1Cursor record(records);
    std::set<std::uint64_t> places;
    bool isSound = true;
    while (isSound && record.next()) {
        if (record.op == Ros1Op::Connection)
            define(record.fields, record.data, indexAt_ + record.at);
        else if (record.op == Ros1Op::ChunkInfo)
            isSound = takeChunkInfo(record, places);
    }
    const bool isWhole = connections_.size() == connectionCount_ && chunks_.size() == chunkCount_;
    if (isSound && !record.isCut() && isWhole)
        return true;
    file_.note(indexAt_ + record.at, isSound && !record.isCut()
                                         ? "the index has " + std::to_string(connections_.size()) +
                                               " connections and " + std::to_string(chunks_.size()) +
                                               " chunks, expected " + std::to_string(connectionCount_) +
                                               " and " + std::to_string(chunkCount_)
                                         : "a record of the index is damaged");
    topics_ = {};
    connections_.clear();
    chunks_.clear();
    definitionBytes_ = 0;
    start_ns_ = end_ns_ = 0;
    return false;
}

/// places: of the chunks so far, so that none is unpacked more than once.
bool Ros1Bag::takeChunkInfo(const Ros1Cursor &record, std::set<std::uint64_t> &places) {
    Chunk chunk;
    std::string_view counts = record.data;
    std::uint32_t connection = 0, count = 0;
    if (!record.fields.number("chunk_pos", chunk.offset) ||
        !record.fields.time("start_time", chunk.start_ns) || !record.fields.time("end_time", chunk.end_ns) ||
        chunk.offset >= indexAt_ || !places.insert(chunk.offset).second)
        return false;
    while (mcap::takeField(counts, connection) && mcap::takeField(counts, count))
        chunk.counts[connection] += count;
    add(std::move(chunk));
    return true;
}

void Ros1Bag::scan() {
    Ros1Head head;
    for (std::uint64_t offset = ros1Magic.size(); (offset = file_.skipZeros(offset)) < file_.size();
         offset = head.end()) {
        if (!file_.readHead(offset, head))
            return;
        if (head.op == Ros1Op::Chunk) {
            scanChunk(head);
        } else if (head.dataBytes > file_.size() - head.dataAt) {
            file_.note(offset, "the last record is cut off: found " + bytesText(file_.size() - head.dataAt) +
                                   " of its " + bytesText(head.dataBytes));
        } else if (head.op == Ros1Op::Message) {
            scanMessage(head);
        } else if (std::string data; head.op == Ros1Op::Connection &&
                                     head.dataBytes <= mcap::mostDefinitions &&
                                     file_.read(head.dataAt, head.dataBytes, data)) {
            define(head.fields, data, offset);
        }
        if (head.dataBytes > file_.size() - head.dataAt)
            return;
    }
}

void Ros1Bag::scanChunk(const Ros1Head &head) {
    Chunk chunk;
    chunk.offset = head.at;
    std::string records;
    if (!file_.unpack(head, records))
        return;
    Ros1Cursor record(records);
    while (record.next())
        if (record.op == Ros1Op::Connection)
            define(record.fields, record.data, head.at);
    bool isFirst = true;
    eachMessage(records, head.at, [&](std::uint32_t connection, std::uint64_t time_ns, std::size_t) {
        chunk.start_ns = isFirst ? time_ns : std::min(chunk.start_ns, time_ns);
        chunk.end_ns = std::max(chunk.end_ns, time_ns);
        ++chunk.counts[connection];
        isFirst = false;
    });
    if (!isFirst)
        add(std::move(chunk));
}

/// A message outside of chunks, as in the last chunk of a bag that was not closed.
void Ros1Bag::scanMessage(const Ros1Head &head) {
    std::uint32_t connection = 0;
    std::uint64_t time_ns = 0;
    if (!head.fields.number("conn", connection) || !head.fields.time("time", time_ns) ||
        connections_.count(connection) == 0) {
        file_.note(head.at, "the message is of no known connection");
        return;
    }
    if (head.end() - head.at > mcap::largestChunk) {
        file_.note(head.at, "found a message of " + bytesText(head.dataBytes) + ", expected at most " +
                                bytesText(mcap::largestChunk));
        return;
    }
    const bool goesOn = !chunks_.empty() && chunks_.back().isLoose &&
                        head.at == chunks_.back().offset + chunks_.back().bytes &&
                        head.end() - chunks_.back().offset <= largestRos1Loose;
    Chunk chunk = goesOn ? std::move(chunks_.back()) : Chunk();
    if (goesOn)
        chunks_.pop_back();
    else
        chunk.offset = head.at;
    chunk.start_ns = goesOn ? std::min(chunk.start_ns, time_ns) : time_ns;
    chunk.end_ns = std::max(chunk.end_ns, time_ns);
    chunk.bytes = head.end() - chunk.offset;
    chunk.isLoose = true;
    ++chunk.counts[connection];
    add(std::move(chunk));
}

/// Only before chunks are sorted.
void Ros1Bag::add(Chunk chunk) {
    start_ns_ = chunks_.empty() ? chunk.start_ns : std::min(start_ns_, chunk.start_ns);
    end_ns_ = std::max(end_ns_, chunk.end_ns);
    chunks_.push_back(std::move(chunk));
}

bool Ros1Bag::load(const Chunk &chunk, std::string &records) {
    if (chunk.isLoose)
        return file_.read(chunk.offset, chunk.bytes, records) || file_.note(chunk.offset, "cannot be read");
    Ros1Head head;
    if (!file_.readHead(chunk.offset, head))
        return false;
    return head.op == Ros1Op::Chunk ? file_.unpack(head, records)
                                    : file_.note(chunk.offset, "there is no chunk");
}

void Ros1Bag::define(const Ros1Fields &fields, std::string_view data, std::uint64_t at) {
    std::uint32_t id = 0;
    Ros1Fields told;
    if (!fields.number("conn", id) || !told.read(data)) {
        file_.note(at, "the connection is damaged");
        return;
    }
    if (connections_.count(id) > 0)
        return;
    if (data.size() > mcap::mostDefinitions - definitionBytes_ || connections_.size() == mostConnections) {
        file_.note(at, "too many connections: the bag tells more than " + bytesText(mcap::mostDefinitions) +
                           " of them");
        return;
    }
    definitionBytes_ += data.size();
    connections_[id] =
        topics_.add({std::string(fields.text("topic")), plainType(std::string(told.text("type"))),
                     std::string(told.text("message_definition")), "ros1", 0});
}

/// Of known connections. offset: of the chunk, for what is noted.
void Ros1Bag::eachMessage(const std::string &records, std::uint64_t offset,
                          const std::function<void(std::uint32_t, std::uint64_t, std::size_t)> &take) {
    Ros1Cursor record(records);
    const auto where = [&] { return "record " + std::to_string(record.at) + " bytes into the chunk: "; };
    while (record.next()) {
        std::uint32_t connection = 0;
        std::uint64_t time_ns = 0;
        if (record.op == Ros1Op::Connection)
            continue;
        if (record.op != Ros1Op::Message)
            file_.note(offset, where() + "found one of kind " + std::to_string(int(record.op)) +
                                   ", expected a message");
        else if (record.fields.number("conn", connection) && record.fields.time("time", time_ns) &&
                 connections_.count(connection) > 0)
            take(connection, time_ns, record.at);
        else
            file_.note(offset, where() + "a message of no known connection");
    }
    if (record.isCut())
        file_.note(offset, "the chunk has a damaged record behind the " + where() + "all after it is lost");
}

void Ros1Bag::select(const std::function<bool(const Topic &)> &wanted) {
    isWanted_.clear();
    for (const Topic &topic : topics())
        isWanted_.push_back(wanted(topic));
    order_.restart();
}

std::optional<Message> Ros1Bag::next() {
    const auto records = order_.next(
        {chunks_.size(), [&](std::size_t i) { return chunks_[i].start_ns; },
         [&](std::size_t i, mcap::OpenChunk &open) { openChunk(chunks_[i], open); },
         [&](std::size_t i) {
             file_.note(chunks_[i].offset, "too many chunks overlap: messages may come out of order");
         }});
    if (!records)
        return std::nullopt;
    Ros1Cursor record(*records);
    Message message;
    std::uint32_t connection = 0;
    record.next();
    record.fields.number("conn", connection);
    record.fields.time("time", message.time_ns);
    message.topic = connections_.at(connection);
    message.data = record.data;
    return message;
}

void Ros1Bag::openChunk(const Chunk &told, mcap::OpenChunk &open) {
    const auto isWanted = [&](std::uint32_t connection) {
        return isWanted_.empty() || isWanted_[connections_.at(connection)];
    };
    const bool isAnyWanted =
        told.counts.empty() || std::any_of(told.counts.begin(), told.counts.end(), [&](const auto &count) {
            return connections_.count(count.first) == 0 || isWanted(count.first);
        });
    open.offset = told.offset;
    if (!isAnyWanted || !load(told, open.records))
        return;
    bool isAsTold = true;
    std::uint64_t expected = 0, found = 0;
    for (const auto &[connection, count] : told.counts)
        expected += count;
    eachMessage(open.records, told.offset,
                [&](std::uint32_t connection, std::uint64_t time_ns, std::size_t at) {
                    isAsTold = isAsTold && time_ns >= told.start_ns && time_ns <= told.end_ns;
                    ++found;
                    if (isWanted(connection))
                        open.messages.emplace_back(time_ns, at);
                });
    if (!isAsTold || found != expected)
        file_.note(told.offset, "the chunk has " + std::to_string(found) + " messages, expected " +
                                    std::to_string(expected) +
                                    ", or some of other times than the index tells");
}

} // namespace hermes::bag
