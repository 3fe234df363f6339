#include "protocol/mcap/Reader.h"
#include "protocol/mcap/Writer.h"
#include "tests/support/Files.h"
#include "tests/support/Rows.h"
#include "tests/support/Seed.h"
#include "tests/support/Texts.h"

#include <QProcess>
#include <QTemporaryDir>
#include <random>

using namespace hermes::mcap;

class TestMcap : public QObject {
    Q_OBJECT

    QTemporaryDir folder_;
    QByteArray bytes_; // that a writer gave its sink

    Writer writer(std::size_t chunkBytes = 1 << 20) {
        bytes_.clear();
        return Writer(
            [this](std::string_view records) {
                bytes_.append(records.data(), int(records.size()));
                return true;
            },
            "test", chunkBytes);
    }

    QString saved(const QByteArray &bytes) {
        const QString path = folder_.filePath("a.mcap");
        QFile::remove(path); // some file systems write to the disk at once what takes the place of a file
        put(path, bytes);
        return path;
    }

    static Reader opened(const QString &path) {
        auto reader = Reader::open(path.toStdString());
        if (!reader)
            qFatal("%s", reader.error().c_str());
        return reader.take();
    }

    /// As tests/support/mcap_reader.py prints it.
    static QByteArray line(const Reader &reader, const Message &m) {
        const auto numbers = QString("%1 %2 %3 ").arg(m.logTime_ns).arg(m.publishTime_ns).arg(m.sequence);
        const std::string &topic = reader.channels().at(m.channel).topic;
        return numbers.toUtf8() + topic.c_str() + ' ' + QByteArray(m.data.data(), int(m.data.size())) + '\n';
    }

    static QByteArray all(Reader &reader) {
        QByteArray lines;
        while (const auto message = reader.next())
            lines += line(reader, *message);
        return lines;
    }

    /// What another reader, which checks everything, finds in the file.
    static QByteArray byOther(const QString &path) {
        QProcess python;
        python.start("python3", {TEST_DATA_DIR "/../support/mcap_reader.py", path});
        python.waitForFinished(-1);
        return python.readAllStandardOutput() + python.readAllStandardError();
    }

    static bool write(Writer &writer, std::uint16_t channel, std::uint64_t time_ns,
                      std::string_view data = "{}") {
        return writer.write({channel, std::uint32_t(time_ns), time_ns, time_ns + 1, data});
    }

    /// Chunks of three messages of two channels; ends: where each ends in the file.
    void makeChunks(int count, std::vector<int> &ends) {
        Writer file = writer();
        const auto schema = file.addSchema("Pose", "jsonschema", "{\"type\":\"object\"}");
        const auto pose = file.addChannel(schema, "scanmatcher/pose", "json", {{"daemon", "scanmatcher"}});
        const auto log = file.addChannel(0, "scanmatcher/log", "json", {});
        for (int i = 0; i < count; ++i) {
            for (const std::uint64_t j : {1, 2, 3})
                QVERIFY(write(file, j == 2 ? log : pose, std::uint64_t(i) * 10 + j, std::string(i * j, 'x')));
            QVERIFY(file.closeChunk());
            ends.push_back(bytes_.size());
        }
        QVERIFY(file.finish());
        QCOMPARE(file.bytes(), std::uint64_t(bytes_.size()));
    }

    static QByteArray number(std::uint64_t value, int size) {
        QByteArray text;
        for (int i = 0; i < size; ++i, value >>= 8)
            text += char(value);
        return text;
    }

    static QByteArray record(int op, const QByteArray &content) {
        return char(op) + number(std::uint64_t(content.size()), 8) + content;
    }

    static QByteArray chunk(std::uint64_t size, const QByteArray &compression, const QByteArray &packed,
                            std::uint64_t packedSize, std::uint32_t sum = 0) {
        return record(6, number(1, 8) + number(9, 8) + number(size, 8) + number(sum, 4) +
                             number(std::uint64_t(compression.size()), 4) + compression +
                             number(packedSize, 8) + packed);
    }

    static inline const QByteArray magic = QByteArray::fromRawData("\x89MCAP0\r\n", 8);
    static inline const QByteArray header = magic + record(1, QByteArray(8, 0));

private Q_SLOTS:
    void whatIsWrittenIsRead() {
        std::vector<int> ends;
        makeChunks(20, ends);
        const QString path = saved(bytes_);
        Reader reader = opened(path);
        QVERIFY(reader.isWhole());
        QCOMPARE(reader.start_ns(), std::uint64_t(1));
        QCOMPARE(reader.end_ns(), std::uint64_t(193));
        QCOMPARE(reader.counts(), (std::map<std::uint16_t, std::uint64_t>{{1, 40}, {2, 20}}));
        QCOMPARE(reader.schemas().at(1).data, std::string("{\"type\":\"object\"}"));
        QCOMPARE(reader.channels().at(1).metadata.at("daemon"), std::string("scanmatcher"));
        QCOMPARE(int(reader.channels().at(1).schema), 1);
        const QByteArray lines = all(reader);
        QCOMPARE(lines.count('\n'), 60);
        QCOMPARE(byOther(path), lines);
        QCOMPARE(reader.problem(), std::string());
    }

    void anEmptyFileIsWhole() {
        Writer file = writer();
        file.addChannel(0, "a", "json", {});
        QVERIFY(file.finish());
        QVERIFY(!file.finish());
        Reader reader = opened(saved(bytes_));
        QVERIFY(reader.isWhole() && !reader.next() && reader.problem().empty());
        QCOMPARE(reader.channels().size(), std::size_t(1));
        QCOMPARE(byOther(saved(bytes_)), QByteArray());
    }

    /// Wherever a file is cut, all whole chunks are read, and are there after it is mended.
    void aCutFileIsMended() {
        std::vector<int> ends;
        makeChunks(4, ends);
        const QByteArray whole = bytes_;
        Reader wholeReader = opened(saved(whole));
        const QByteArrayList lines = all(wholeReader).split('\n');
        std::mt19937 random(newSeed());
        for (int size = 0; size < whole.size(); ++size) {
            const QString path = saved(whole.left(size));
            Reader cut = opened(path);
            QVERIFY(!cut.isWhole());
            const QByteArray found = all(cut);
            const auto chunks = std::upper_bound(ends.begin(), ends.end(), size) - ends.begin();
            QVERIFY2(found.count('\n') >= 3 * chunks, saying("cut at %1", size));
            QVERIFY(size >= 29 || !cut.problem().empty()); // the header
            QVERIFY(lines.join('\n').startsWith(found));

            const auto repaired = repair(path.toStdString());
            QVERIFY2(repaired, saying("cut at %1", size));
            QCOMPARE(repaired->bytes, std::uint64_t(QFileInfo(path).size()));
            Reader mended = opened(path);
            QVERIFY(mended.isWhole());
            QCOMPARE(all(mended), found);
            QCOMPARE(mended.problem(), std::string());
            QCOMPARE(mended.counts(), repaired->contents.counts);
            QVERIFY(mended.start_ns() == cut.start_ns() && mended.end_ns() == cut.end_ns());
            if (random() % 128 == 0)
                QCOMPARE(byOther(path), found);
            const QByteArray after = contentOf(path);
            QVERIFY(repair(path.toStdString())->whole);
            QCOMPARE(contentOf(path), after);
        }
    }

    /// Whatever byte is damaged, the other chunks are read.
    void damageIsTold() {
        std::vector<int> ends;
        makeChunks(4, ends);
        const QByteArray whole = bytes_;
        for (int at = 8; at < whole.size(); ++at) {
            QByteArray damaged = whole;
            damaged[at] = char(damaged[at] ^ 0x55);
            auto reader = Reader::open(saved(damaged).toStdString());
            if (!reader) {
                QVERIFY(at < 17); // the header's head
                continue;
            }
            const int lines = all(*reader).count('\n');
            QVERIFY2(lines >= 9, saying("damaged at %1: %2", at, lines));
            QVERIFY2(lines == 12 || !reader->problem().empty(), saying("damaged at %1", at));
        }
    }

    void messagesAreInTheOrderOfTime() {
        Writer file = writer();
        const auto a = file.addChannel(0, "a", "json", {}), b = file.addChannel(0, "b", "json", {});
        const std::vector<std::vector<std::uint64_t>> chunks = {{1, 9, 5}, {4, 2, 4}, {20, 21}, {9, 3}, {}};
        std::vector<std::uint64_t> times;
        for (const auto &chunk : chunks) {
            for (const std::uint64_t time_ns : chunk) {
                QVERIFY(write(file, time_ns % 2 == 0 ? b : a, time_ns, std::to_string(times.size())));
                times.push_back(time_ns);
            }
            QVERIFY(file.closeChunk());
        }
        QVERIFY(file.finish());
        Reader reader = opened(saved(bytes_));
        const auto read = [&] {
            std::vector<std::pair<std::uint64_t, int>> found;
            while (const auto message = reader.next())
                found.emplace_back(message->logTime_ns, std::stoi(std::string(message->data)));
            return found;
        };
        using Pairs = std::vector<std::pair<std::uint64_t, int>>;
        QCOMPARE(read(),
                 (Pairs{{1, 0}, {2, 4}, {3, 9}, {4, 3}, {4, 5}, {5, 2}, {9, 1}, {9, 8}, {20, 6}, {21, 7}}));
        reader.seek(9);
        QCOMPARE(read(), (Pairs{{9, 1}, {9, 8}, {20, 6}, {21, 7}}));
        reader.select([](const Channel &channel) { return channel.topic == "b"; });
        QCOMPARE(read(), (Pairs{{20, 6}}));
        reader.seek(0);
        QCOMPARE(read(), (Pairs{{2, 4}, {4, 3}, {4, 5}, {20, 6}}));
        reader.seek(22);
        QVERIFY(!reader.next());
    }

    void manyChunksThatOverlap() {
        Writer file = writer();
        const auto a = file.addChannel(0, "a", "json", {});
        for (std::uint64_t i = 0; i < 100; ++i)
            QVERIFY(write(file, a, i) && write(file, a, 1000 + i) && file.closeChunk());
        QVERIFY(file.finish());
        Reader reader = opened(saved(bytes_));
        QCOMPARE(all(reader).count('\n'), 200);
        QVERIFY(reader.problem().find("overlap") != std::string::npos);
    }

    void largeMessages() {
        Writer file = writer(1000);
        const auto a = file.addChannel(0, "a", "json", {});
        std::string large(5000, 'a');
        for (char &c : large)
            c = char('a' + (&c - large.data()) * 7919 % 26);
        QVERIFY(write(file, a, 1) && write(file, a, 2, large) && write(file, a, 3));
        QVERIFY(!write(file, a, 4, std::string(Writer::largestMessage + 1, ' ')));
        QVERIFY(write(file, a, 5, std::string(Writer::largestMessage, ' ')));
        QVERIFY(!write(file, 7, 6));
        QVERIFY(file.finish());
        Reader reader = opened(saved(bytes_));
        std::vector<std::size_t> sizes;
        while (const auto message = reader.next())
            sizes.push_back(message->data.size());
        QCOMPARE(sizes, (std::vector<std::size_t>{2, 5000, 2, Writer::largestMessage}));
        QCOMPARE(reader.problem(), std::string());
    }

    void afterAFailureNothingIsWritten() {
        int calls = 0;
        Writer file([&](std::string_view) { return ++calls < 3; }, "test");
        const auto a = file.addChannel(0, "a", "json", {});
        const std::uint64_t bytes = file.bytes();
        QVERIFY(write(file, a, 1) && !file.closeChunk() && !write(file, a, 2) && !file.finish());
        QCOMPARE(calls, 3);
        QCOMPARE(file.bytes(), bytes);
    }

    void idsEnd() {
        Writer file([](std::string_view) { return true; }, "test");
        QCOMPARE(int(file.addChannel(1, "of no schema", "json", {})), 0);
        for (int i = 1; i < 65536; ++i)
            QCOMPARE(int(file.addSchema("", "", "")), i);
        QCOMPARE(int(file.addSchema("", "", "")), 0);
    }

    /// A reader would not take them either.
    void definitionsHaveALimit() {
        Writer file = writer();
        const std::string large(mostDefinitions / 2, ' ');
        const auto schema = file.addSchema("a", "jsonschema", large);
        QCOMPARE(int(schema), 1);
        const std::uint64_t bytes = file.bytes();
        QCOMPARE(int(file.addSchema("b", "jsonschema", large)), 0);
        QCOMPARE(int(file.addChannel(schema, large, "json", {})), 0);
        QCOMPARE(file.bytes(), bytes);
        const auto a = file.addChannel(schema, "a", "json", {});
        QVERIFY(write(file, a, 1) && file.closeChunk());
        const QByteArray cut = bytes_;
        QVERIFY(file.finish());
        for (const QByteArray &content : {bytes_, cut}) {
            Reader reader = opened(saved(content));
            QCOMPARE(all(reader), QByteArray("1 2 1 a {}\n"));
            QCOMPARE(reader.problem(), std::string());
        }
    }

    /// As some writers do it, so that each chunk can be read alone.
    void definitionsThatComeAgainCountOnce() {
        Writer file = writer();
        const std::string large(mostDefinitions / 2, ' ');
        QCOMPARE(int(file.addSchema("a", "jsonschema", large)), 1);
        const QByteArray schema = bytes_.mid(29);
        Reader reader = opened(saved(bytes_ + schema + schema));
        QVERIFY(!reader.isWhole());
        QCOMPARE(reader.schemas().at(1).data, large);
        QCOMPARE(reader.problem(), std::string());
    }

    void hostileChunksAreLeftOut_data() {
        const Rows<QByteArray, QByteArray> row("bytes", "problem");
        row("bomb", chunk(std::uint64_t(1) << 40, "zstd", "abcd", 4), "cannot be unpacked");
        row("64 MiB of nothing", chunk(64 << 20, "zstd", "abcd", 4), "cannot be unpacked");
        row("no zstd", chunk(100, "zstd", "abcd", 4), "cannot be unpacked");
        row("another size", chunk(5, "", "abcd", 4), "size");
        row("lz4", chunk(4, "lz4", "abcd", 4), "lz4");
        row("more than there is", chunk(4, "", "abcd", ~std::uint64_t(0)), "shorter");
        row("another sum", chunk(4, "", "abcd", 4, 1), "sum");
        row("a cut record", chunk(4, "", "abcd", 4), "damaged records");
        row("a message without fields", chunk(10, "", record(5, "a"), 10), "damaged records");
        row("no channel", chunk(31, "", record(5, QByteArray(22, 1)), 31), "no known channel");
        row("a message outside", record(5, QByteArray(22, 1)), "no known channel");
        row("a schema without a name", record(3, "ab"), "schema or channel");
        row("metadata that are longer", record(4, QByteArray(12, 0) + number(~0u, 4)), "schema or channel");
        row("a record of all bytes", char(6) + number(~std::uint64_t(0), 8), "no whole record");
        row("zeros", QByteArray(5000, 0), "no whole record");
    }

    void hostileChunksAreLeftOut() {
        FETCH(QByteArray, bytes, QByteArray, problem);
        const QString path = saved(header + bytes);
        Reader reader = opened(path);
        QVERIFY(!reader.isWhole() && !reader.next());
        VERIFY_CONTAINS(QString::fromStdString(reader.problem()), problem);
        const auto repaired = repair(path.toStdString());
        QVERIFY(repaired);
        QCOMPARE(repaired->problem, reader.problem());
        QVERIFY(opened(path).isWhole());
    }

    /// As lz4 packs what does not get smaller.
    void chunksOfLz4() {
        const auto channel =
            record(4, number(1, 2) + number(0, 2) + number(1, 4) + "a" + number(0, 4) + number(0, 4));
        const auto records =
            channel + record(5, number(1, 2) + number(7, 4) + number(3, 8) + number(4, 8) + "data");
        const QByteArray packed = QByteArray::fromHex("04224d18604082") +
                                  number(std::uint64_t(records.size()) | 0x80000000, 4) + records +
                                  QByteArray(4, 0);
        const QByteArray bytes =
            chunk(std::uint64_t(records.size()), "lz4", packed, std::uint64_t(packed.size()));
        Reader reader = opened(saved(header + bytes));
        if (reader.problem().find("without liblz4") != std::string::npos)
            QSKIP("built without liblz4");
        QCOMPARE(all(reader), QByteArray("3 4 7 a data\n"));
        for (int size = 0; size < packed.size(); ++size) {
            Reader cut = opened(saved(header + chunk(std::uint64_t(records.size()), "lz4", packed.left(size),
                                                     std::uint64_t(size))));
            QVERIFY2(all(cut).isEmpty() && cut.problem().find("unpacked") != std::string::npos,
                     saying("cut at %1: %2", size, QString::fromStdString(cut.problem())));
        }
    }

    /// Some writers make no chunks, or not of all; with a summary that tells of the chunks alone, too.
    void messagesOutsideOfChunks() {
        Writer file = writer();
        const auto a = file.addChannel(0, "a", "json", {});
        QVERIFY(write(file, a, 5, "five") && file.closeChunk());
        const QByteArray loose =
            record(5, number(a, 2) + number(3, 4) + number(3, 8) + number(4, 8) + "three");
        const QByteArray open = bytes_ + loose + record(0x7E, "something new") + loose;
        const QByteArray lines = "3 4 3 a three\n3 4 3 a three\n5 6 5 a five\n";
        Reader cut = opened(saved(open));
        QCOMPARE(all(cut), lines);
        QVERIFY(cut.problem().empty() && !cut.isWhole());
        QCOMPARE(cut.counts().at(a), std::uint64_t(3));
        const QString path = saved(open);
        QVERIFY(repair(path.toStdString()));
        Reader mended = opened(path);
        QVERIFY(mended.isWhole());
        QCOMPARE(all(mended), lines);
        QCOMPARE(mended.problem(), std::string());
    }

    void hostileSummaries_data() {
        const Rows<QByteArray, quint64> row("summary", "begin");
        const QByteArray index = number(1, 8) + number(2, 8) + number(8, 8) + number(21, 8);
        const QByteArray rest = number(0, 4) + number(0, 8) + number(0, 4) + number(0, 16);
        row("beyond the file", "", ~quint64(0));
        row("in the footer", "", 60);
        row("a cut record", "abc", 29);
        row("a chunk twice", record(8, index + rest) + record(8, index + rest), 29);
        row("a chunk beyond", record(8, number(1, 16) + number(1 << 30, 8) + number(9, 8) + rest), 29);
        row("a chunk of all", record(8, number(1, 16) + number(8, 8) + number(~0ull, 8) + rest), 29);
        row("counts that are longer", record(11, QByteArray(42, 0) + number(~0u, 4)), 29);
    }

    void hostileSummaries() {
        FETCH(QByteArray, summary, quint64, begin);
        const QByteArray bytes = magic + record(1, QByteArray(12, 0)) + summary +
                                 record(2, number(begin, 8) + number(0, 8) + number(0, 4)) + magic;
        Reader reader = opened(saved(bytes));
        QVERIFY(!reader.isWhole() && !reader.next() && !reader.problem().empty());
        QVERIFY(repair(saved(bytes).toStdString()));
        QVERIFY(opened(folder_.filePath("a.mcap")).isWhole());
    }

    void otherFilesAreRefused() {
        put(folder_.filePath("text"), "a text that is longer than a header of MCAP");
        put(folder_.filePath("op"), magic + char(2));
        put(folder_.filePath("length"), magic + char(1) + number(5000, 8)); // too much to have been cut off
        for (const QString name : {"text", "op", "length", "", "missing"}) {
            const std::string path = folder_.filePath(name).toStdString();
            QVERIFY(!Reader::open(path) && !repair(path));
            QCOMPARE(Reader::open(path).error().rfind(path, 0), std::size_t(0));
        }
        QCOMPARE(contentOf(folder_.filePath("op")), magic + char(2));
        QVERIFY(!Reader::open("/dev/zero"));
    }
};
