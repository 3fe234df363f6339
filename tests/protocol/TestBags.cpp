// Bags byte by byte: whole, never closed, cut off, damaged, hostile. tests/gui/vector_bags.py has those of
// other writers.
#include "protocol/bag/Metadata.h"
#include "protocol/bag/Reader.h"
#include "tests/support/Files.h"
#include "tests/support/Rows.h"
#include "tests/support/Seed.h"
#include "tests/support/Texts.h"

#include <QProcess>
#include <QTemporaryDir>
#include <random>

using namespace hermes::bag;

class TestBags : public QObject {
    Q_OBJECT

    QTemporaryDir folder_;

    static QByteArray number(std::uint64_t value, int size) {
        QByteArray text;
        for (int i = 0; i < size; ++i, value >>= 8)
            text += char(value);
        return text;
    }
    static QByteArray sized(const QByteArray &bytes) {
        return number(std::uint64_t(bytes.size()), 4) + bytes;
    }
    /// fields: name=value each.
    static QByteArray record(const QByteArrayList &fields, const QByteArray &data) {
        QByteArray header;
        for (const QByteArray &field : fields)
            header += sized(field);
        return sized(header) + sized(data);
    }
    static QByteArray op(int kind) { return "op=" + QByteArray(1, char(kind)); }
    static QByteArray stamp(int ms) {
        return number(std::uint64_t(ms / 1000), 4) + number(std::uint64_t(ms % 1000) * 1000000, 4);
    }

    static QByteArray connection(int id, const QByteArray &topic,
                                 const QByteArray &type = "std_msgs/String") {
        return record({op(7), "conn=" + number(std::uint64_t(id), 4), "topic=" + topic},
                      sized("topic=" + topic) + sized("type=" + type) + sized("md5sum=abc") +
                          sized("message_definition=string data\n"));
    }
    static QByteArray message(int id, int ms, const QByteArray &data) {
        return record({"time=" + stamp(ms), "conn=" + number(std::uint64_t(id), 4), op(2)}, data);
    }
    static QByteArray chunk(const QByteArray &records, const QByteArray &compression = "none",
                            int size = -1) {
        return record({"compression=" + compression, op(5),
                       "size=" + number(std::uint64_t(size < 0 ? records.size() : size), 4)},
                      records);
    }
    /// As lz4 packs what does not get smaller.
    static QByteArray lz4(const QByteArray &bytes) {
        return QByteArray::fromHex("04224d18604082") + number(std::uint64_t(bytes.size()) | 0x80000000, 4) +
               bytes + QByteArray(4, 0);
    }
    static QByteArray fileHeader(int indexAt, int connections, int chunks) {
        QByteArray header = record({"index_pos=" + number(std::uint64_t(indexAt), 8),
                                    "conn_count=" + number(std::uint64_t(connections), 4),
                                    "chunk_count=" + number(std::uint64_t(chunks), 4), op(3)},
                                   QByteArray(20, ' '));
        return "#ROSBAG V2.0\n" + header;
    }

    /// Two chunks that overlap, of two topics, the second packed by lz4. ends: where each ends in the file.
    static QByteArray bag(bool isClosed = true, std::vector<int> *ends = nullptr) {
        const QByteArray a = connection(0, "/a"), b = connection(1, "b");
        QByteArray bytes = fileHeader(0, 2, 2);
        const int first = bytes.size();
        bytes += chunk(a + message(0, 1000, "one") + message(0, 5000, "four"));
        const int second = bytes.size();
        const QByteArray records =
            b + message(1, 2000, "two") + message(0, 3000, "three") + message(1, 6000, "");
        bytes += chunk(lz4(records), "lz4", records.size());
        const int end = bytes.size();
        if (ends)
            *ends = {second, end};
        if (!isClosed)
            return bytes;
        const auto info = [](int place, int from, int to, const QByteArray &counts) {
            return record({op(6), "ver=" + number(1, 4), "chunk_pos=" + number(std::uint64_t(place), 8),
                           "start_time=" + stamp(from), "end_time=" + stamp(to), "count=" + number(2, 4)},
                          counts);
        };
        bytes += a + b + info(first, 1000, 5000, number(0, 4) + number(2, 4)) +
                 info(second, 2000, 6000, number(0, 4) + number(1, 4) + number(1, 4) + number(2, 4));
        return bytes.replace(0, first, fileHeader(end, 2, 2));
    }

    QString saved(const QByteArray &bytes, const char *name = "a.bag") {
        const QString path = folder_.filePath(name);
        QFile::remove(path);
        put(path, bytes);
        return path;
    }
    static std::unique_ptr<Reader> opened(const QString &path) {
        auto reader = open(path.toStdString());
        if (!reader)
            qFatal("%s", reader.error().c_str());
        return reader.take();
    }
    /// Topic, time in ms and data of each message.
    static QByteArrayList all(Reader &reader) {
        QByteArrayList lines;
        while (const auto message = reader.next())
            lines += QByteArray::fromStdString(reader.topics()[message->topic].name) + ' ' +
                     QByteArray::number(quint64(message->time_ns / 1000000)) + ' ' +
                     QByteArray(message->data.data(), int(message->data.size()));
        return lines;
    }
    static QString problemOf(const Reader &reader) { return QString::fromStdString(reader.problem()); }
    const QByteArrayList lines_{"/a 1000 one", "b 2000 two", "/a 3000 three", "/a 5000 four", "b 6000 "};

    /// A database with three messages of two topics.
    QByteArray database() {
        const QString path = folder_.filePath("made.db3");
        QFile::remove(path);
        QProcess python;
        python.start("python3", {"-c", R"py(
import sqlite3, sys
d = sqlite3.connect(sys.argv[1])
d.execute("PRAGMA page_size=512")
d.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name, type, serialization_format, offered_qos_profiles)")
d.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data)")
d.execute("CREATE INDEX timestamp_idx ON messages(timestamp)")
d.execute("CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type, encoding, encoded_message_definition)")
d.execute("INSERT INTO message_definitions(topic_type, encoding, encoded_message_definition) VALUES "
          "('std_msgs/msg/String', 'ros2msg', 'string data'), ('pkg/msg/Other', 'ros2idl', 'module pkg {')")
d.execute("INSERT INTO topics VALUES (7, '/a', 'std_msgs/msg/String', 'cdr', ''), (9, 'b', 'pkg/msg/Other', 'cdr', '')")
for id, topic, ms, data in (1, 7, 1000, b"one"), (2, 9, 3000, b"three"), (3, 7, 2000, b"two" * 300):
    d.execute("INSERT INTO messages VALUES (?, ?, ?, ?)", (id, topic, ms * 1000000, data))
d.commit()
)py",
                                 path});
        python.waitForFinished();
        return contentOf(path);
    }

private Q_SLOTS:
    void whatIsWrittenIsRead() {
        const auto reader = opened(saved(bag()));
        QCOMPARE(reader->kind(), std::string("bag of ROS 1, version 2.0"));
        QCOMPARE(reader->topics().size(), std::size_t(2));
        QCOMPARE(reader->topics()[0].name, std::string("/a"));
        QCOMPARE(reader->topics()[1].type, std::string("std_msgs/String"));
        QCOMPARE(reader->topics()[1].definition, std::string("string data\n"));
        QCOMPARE(reader->topics()[0].messages, std::uint64_t(3));
        QCOMPARE(reader->start_ns(), std::uint64_t(1000000000));
        QCOMPARE(reader->end_ns(), std::uint64_t(6000000000));
        QCOMPARE(all(*reader), lines_);
        reader->select([](const Topic &topic) { return topic.name == "b"; });
        QCOMPARE(all(*reader), (QByteArrayList{lines_[1], lines_[4]}));
        QCOMPARE(problemOf(*reader), QString());
    }

    void aBagThatWasNotClosed() {
        // Its last chunk tells no size yet: its records follow, and zeros of a file that was made longer.
        const QByteArray open = bag(false) + chunk("", "none", 0) + connection(2, "c") +
                                message(2, 7000, "five") + message(0, 6500, "between") + QByteArray(49, 0) +
                                message(1, 8000, "six") + QByteArray(7000, 0);
        const auto reader = opened(saved(open));
        QCOMPARE(all(*reader), lines_ + QByteArrayList({"/a 6500 between", "c 7000 five", "b 8000 six"}));
        QCOMPARE(problemOf(*reader), QString());
        QCOMPARE(reader->topics()[2].messages, std::uint64_t(1));
    }

    /// Wherever a bag is cut, all whole chunks are read, and it is told where it is cut.
    void aCutBagIsReadUpToThere() {
        std::vector<int> ends;
        const QByteArray whole = bag(true, &ends);
        for (int size = 0; size < whole.size(); ++size) {
            auto reader = open(saved(whole.left(size)).toStdString());
            if (!reader) {
                QVERIFY(size < 13);
                continue;
            }
            const QByteArrayList found = all(**reader);
            QVERIFY2(found.size() >= (size < ends[0]   ? 0
                                      : size < ends[1] ? 2
                                                       : 5),
                     saying("cut at %1", size));
            for (const QByteArray &line : found)
                QVERIFY2(lines_.contains(line), line);
            VERIFY_STARTS(problemOf(**reader), "byte ");
        }
    }

    /// Whatever byte is damaged, the other messages are read, and none is missing without a word.
    void damageIsTold() {
        const QByteArray whole = bag();
        for (int at = 13; at < whole.size(); ++at) {
            QByteArray damaged = whole;
            damaged[at] = char(damaged[at] ^ 0x55);
            const auto reader = open(saved(damaged).toStdString());
            QVERIFY2(reader, saying("damaged at %1", at));
            const int found = all(**reader).size();
            QVERIFY2(found == 5 || !(*reader)->problem().empty(), saying("damaged at %1: %2", at, found));
        }
    }

    void hostileBags_data() {
        const Rows<QByteArray, QByteArray> row("records", "problem");
        row("bomb", chunk("abcd", "bz2", 60 << 20), "found a chunk of 4 bytes");
        row("no bz2", chunk(QByteArray(4000, 'x'), "bz2", 4000), "cannot be unpacked");
        row("no lz4", chunk("abcd", "lz4", 100), "cannot be unpacked");
        row("another size", chunk(lz4("abcd"), "lz4", 100), "has 4 bytes, and not 100");
        row("larger", chunk(lz4("abcd"), "lz4", 2), "cannot be unpacked");
        row("another compression", chunk("abcd", "fancy"), "compression 'fancy', expected none, bz2 or lz4");
        row("a chunk without a size", record({op(5), "compression=lz4"}, lz4("abcd")), "cannot be unpacked");
        row("a cut record", chunk("abcd"), "damaged record");
        row("no connection", chunk(message(5, 1, "")), "no known connection");
        row("a loose message of none", message(5, 1, ""), "no known connection");
        row("a connection without a number", record({op(7), "topic=a"}, ""), "the connection is damaged");
        row("a long header", number(1 << 20, 4) + QByteArray(100, 1), "header of 1048576 bytes");
        row("a header without kind", record({"conn=abcd"}, ""), "no field op");
        row("a field without a name", record({"conn"}, ""), "no field op");
        row("data of all bytes", sized(sized(op(7))) + number(~0u, 4), "cut off");
        row("a chunk of all bytes", sized(sized(op(5)) + sized("compression=bz2")) + number(~0u, 4),
            "is cut off");
    }
    void hostileBags() {
        FETCH(QByteArray, records, QByteArray, problem);
        const QByteArray bytes = fileHeader(0, 0, 0);
        const auto reader = opened(saved(bytes + records));
        QCOMPARE(all(*reader), QByteArrayList());
        VERIFY_CONTAINS(problemOf(*reader), problem);
        VERIFY_STARTS(problemOf(*reader), QString("byte %1: ").arg(bytes.size()));
    }

    void otherFilesAreRefused() {
        for (const auto &[content, words] :
             {std::pair<QByteArray, QString>("#ROSBAG V1.1\n", "found #ROSBAG V1.1"),
              {"text", "another file"},
              {"", "an empty file"},
              {"#ROSBAG V2.0\n" +
                   record({op(3), "encryptor=rosbag/AesCbc", "index_pos=" + QByteArray(8, 0)}, ""),
               "rosbag/AesCbc"},
              {"SQLite format 3", "another file"},
              {QByteArray("SQLite format 3\0abc", 19), "SQL"}}) {
            const auto reader = open(saved(content).toStdString());
            QVERIFY(!reader);
            VERIFY_STARTS(QString::fromStdString(reader.error()), folder_.filePath("a.bag") + ": ");
            if (content != QByteArray("SQLite format 3\0abc", 19))
                VERIFY_CONTAINS(QString::fromStdString(reader.error()), words);
        }
        QVERIFY(!open("/dev/zero") && !open(folder_.path().toStdString()) && !open("/nowhere"));
        QVERIFY(!isBag("/dev/zero") && !isBag(folder_.path().toStdString()));
        QVERIFY(isBag(saved(bag(), "name-without-extension").toStdString()));
    }

    void aDatabaseIsRead() {
        const auto made = open(saved(database(), "a.db3").toStdString());
        if (!made && made.error().find("without libsqlite3") != std::string::npos)
            QSKIP("built without libsqlite3");
        QVERIFY2(made, made ? "" : made.error().c_str());
        Reader &reader = **made;
        QCOMPARE(reader.topics()[1].type, std::string("pkg/Other"));
        QCOMPARE(reader.topics()[0].messages, std::uint64_t(2));
        QCOMPARE(reader.topics()[0].definition, std::string("string data"));
        QCOMPARE(reader.topics()[1].definition, std::string());
        QCOMPARE(reader.end_ns(), std::uint64_t(3000000000));
        const QByteArrayList lines{"/a 1000 one", "/a 2000 " + QByteArray("two").repeated(300),
                                   "b 3000 three"};
        QCOMPARE(all(reader), lines);
        reader.select([](const Topic &topic) { return topic.name == "b"; });
        QCOMPARE(all(reader), QByteArrayList({lines[2]}));
        reader.select([](const Topic &) { return false; });
        QCOMPARE(all(reader), QByteArrayList());
        QCOMPARE(problemOf(reader), QString());
    }

    /// Whatever happened to it: an end, and a word where messages are missing.
    void aSpoiledDatabase_data() { falseAndTrue("cut", "damaged", "cut"); }
    void aSpoiledDatabase() {
        QFETCH(bool, cut);
        const QByteArray whole = database();
        const auto first = open(saved(whole, "a.db3").toStdString());
        if (!first)
            QSKIP("built without libsqlite3");
        std::mt19937 random(newSeed());
        for (int i = 0; i < 200; ++i) {
            const int at = int(random() % unsigned(whole.size()));
            QByteArray spoiled = cut ? whole.left(at) : whole;
            if (!cut)
                spoiled[at] = char(spoiled[at] ^ (1 << random() % 8));
            const auto reader = open(saved(spoiled, "a.db3").toStdString());
            if (!reader) {
                VERIFY_STARTS(QString::fromStdString(reader.error()), folder_.filePath("a.db3") + ": ");
                continue;
            }
            const int found = all(**reader).size();
            QVERIFY2(found <= 6, saying("%1 at %2", found, at));
            QVERIFY2(!cut || found == 3 || !(*reader)->problem().empty(), saying("cut at %1", at));
        }
    }

    void metadata() {
        const Metadata none = readMetadata("a: b\nrelative_file_paths:\n");
        QVERIFY(!none.isBag && none.files.empty());
        const Metadata found =
            readMetadata("rosbag2_bagfile_information:\r\n  version: 5\r\n  relative_file_paths:\r\n"
                         "    - a/b_0.db3\r\n    - \"../../c.db3\"\r\n    - ..\r\n"
                         "  compression_format: 'zstd'\r\n  files:\r\n    - path: x.db3\r\n");
        QVERIFY(found.isBag);
        QCOMPARE(found.files, (std::vector<std::string>{"b_0.db3", "c.db3"}));
        QCOMPARE(found.compression, std::string("zstd"));
        QCOMPARE(readMetadata("relative_file_paths: [a.db3, 'b.db3']").files,
                 (std::vector<std::string>{"a.db3", "b.db3"}));
    }
};
