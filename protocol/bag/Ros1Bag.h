#pragma once

#include "protocol/bag/Ros1File.h"
#include "protocol/bag/TopicList.h"
#include "protocol/mcap/ChunkOrder.h"

#include <map>
#include <set>

namespace hermes::bag {

/// A bag of ROS 1, version 2.0: by its index, or from its beginning where it was never closed or cut off.
/// Chunks are plain, or packed by bz2 or lz4. Bad chunks are left out. Memory: as of mcap::ChunkOrder.
class Ros1Bag : public Reader {
public:
    /// Whether bytes begin like a bag of any version.
    static bool isOne(std::string_view begin);
    /// Fails when it is of another version or encrypted.
    static Outcome<std::unique_ptr<Reader>> open(mcap::File file);

    std::string kind() const override;
    const std::vector<Topic> &topics() const override { return topics_.all(); }
    std::uint64_t start_ns() const override { return start_ns_; }
    std::uint64_t end_ns() const override { return end_ns_; }
    void select(const std::function<bool(const Topic &)> &wanted) override;
    std::optional<Message> next() override;
    std::string problem() const override { return file_.problem(); }

private:
    struct Chunk {
        std::uint64_t start_ns = 0, end_ns = 0;
        std::uint64_t offset = 0, bytes = 0;           // of the record in the file; bytes 0: not known yet
        bool isLoose = false;                          // no chunk: records that stand in the file themselves
        std::map<std::uint32_t, std::uint64_t> counts; // messages of each connection
    };
    explicit Ros1Bag(mcap::File file)
        : file_(std::move(file)) {}
    std::string readFileHeader();
    bool readIndex();
    bool takeChunkInfo(const Ros1Cursor &record, std::set<std::uint64_t> &places);
    void scan();
    void scanChunk(const Ros1Head &head);
    void scanMessage(const Ros1Head &head);
    bool load(const Chunk &chunk, std::string &records);
    void define(const Ros1Fields &fields, std::string_view data, std::uint64_t at);
    void eachMessage(
        const std::string &records, std::uint64_t offset,
        const std::function<void(std::uint32_t connection, std::uint64_t time_ns, std::size_t at)> &take);
    void add(Chunk chunk);
    void openChunk(const Chunk &told, mcap::OpenChunk &open);

    Ros1File file_;
    std::uint64_t indexAt_ = 0;                          // 0: the bag was not closed
    std::uint32_t connectionCount_ = 0, chunkCount_ = 0; // as the header tells
    bool isIndexed_ = false;
    TopicList topics_;
    std::map<std::uint32_t, std::size_t> connections_; // to the place of their topics
    std::uint64_t definitionBytes_ = 0;
    std::vector<Chunk> chunks_; // in the order of their least times
    std::uint64_t start_ns_ = 0, end_ns_ = 0;
    std::vector<bool> isWanted_; // of each topic; empty: all
    mcap::ChunkOrder order_;
};

} // namespace hermes::bag
