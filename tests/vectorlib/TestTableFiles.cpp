#include <vectorlib/io/Csv.h>
#include <vectorlib/io/CsvPoints.h>
#include <vectorlib/io/MapCsv.h>
#include <vectorlib/io/Pcd.h>

using namespace vectorlib;

/// How many rows a reader finds, or its message.
static std::pair<int, QByteArray> outcome(const QByteArray &kind, const QByteArray &text) {
    std::istringstream in(text.toStdString());
    const auto result = [](const auto &read, auto count) {
        return read ? std::pair(int(count(*read)), QByteArray())
                    : std::pair(-1, QByteArray::fromStdString(read.error().message()));
    };
    const auto size = [](const auto &v) { return v.size(); };
    if (kind == "points")
        return result(readCsvPoints<double>(in, "f"), size);
    if (kind == "float points")
        return result(readCsvPoints<float>(in, "f"), size);
    if (kind == "float pcd")
        return result(readPcd<float>(in, "f"), size);
    if (kind == "pcd")
        return result(readPcd<double>(in, "f"), size);
    if (kind == "segments")
        return result(readCsvSegments(in, "f"), [](const auto &t) { return t.segments.size(); });
    if (kind == "map")
        return result(readMapCsv(in, "f"), size);
    return result(readCsvPairs(in, "f"), [](const auto &t) { return t.pairs.size(); });
}

static const QByteArray pcdHeader =
    "# .PCD v0.7\nVERSION 0.7\nFIELDS i x y\nSIZE 4 4 4\nTYPE F F F\nCOUNT 2 1 1\nWIDTH 2\nHEIGHT "
    "1\nVIEWPOINT 0 0 0 1 0 0 0\n";
static const QByteArray pairRow = "0,0,1,0,5,5,6,5";

/// Points, segments, pairs and maps from text: what is accepted, what is refused and how it is said.
class TestTableFiles : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void goodInput_data() {
        const Rows<QByteArray, QByteArray, int> row("kind", "text", "rows");
        row("no header", "points", "1,2\n3,4\n", 2);
        row("comments, header, blank lines", "points", "# a scan\nx,y\n\n 1 , 2\n# in between\n3,+4e0\n", 2);
        row("CR LF and no last line end", "points", "x,y\r\n1,2\r\n3,4", 2);
        row("CR alone", "points", "x,y\r1,2\r3,4\r", 2);
        row("rays without return", "points", "inf,nan\n1,2\nnan,3\n-Infinity,4\n3,4\n", 2);
        row("rays without return in a pcd", "pcd", pcdHeader + "POINTS 2\nDATA ascii\n9 9 nan inf\n9 9 3 4\n",
            1);
        row("map in UTM", "map",
            "id,x1,y1,x2,y2,n,sigma,observations,mean_x,mean_y,xx,xy,yy\n"
            "5,691608.9,1e7,691609.9,1e7,2,0,1,691609.4,1e7,1,0,1\n",
            1);
        row("byte order mark", "points", "\xEF\xBB\xBFx,y\n1,2\n3,4\n", 2);
        row("byte order mark, no header", "points",
            "\xEF\xBB\xBF"
            "1,2\n3,4\n",
            2);
        row("columns by name", "points", "index,y,x\n0,1,2\n", 1);
        row("header alone", "points", "x,y\n", 0);
        row("further columns", "segments", "1,2,3,4,wall\n5,6,7,8,door\n", 2);
        row("columns of a map", "segments", "id,x1,y1,x2,y2,n\n7,0,0,1,1,3\n", 1);
        row("pairs", "pairs", pairRow + '\n' + pairRow, 2);
        row("pairs with weights", "pairs", "sx1,sy1,sx2,sy2,dx1,dy1,dx2,dy2,weight\n" + pairRow + ",0.5\n",
            1);
        row("pcd after a byte order mark", "pcd",
            "\xEF\xBB\xBF" + pcdHeader + "POINTS 1\nDATA ascii\n9 9 1 2\n", 1);
        row("pcd", "pcd", pcdHeader + "POINTS 2\nDATA ascii\n9 9 1 2\n9 9 3 4\n", 2);
    }
    void goodInput() {
        FETCH(QByteArray, kind, QByteArray, text);
        const auto [rows, message] = outcome(kind, text);
        QVERIFY2(rows >= 0, message.constData());
        QTEST(rows, "rows");
    }

    void badInput_data() {
        const Rows<QByteArray, QByteArray, QByteArray, QByteArray> row("kind", "text", "place", "said");
        row("empty", "points", "", "f", "an empty file, expected columns x,y");
        row("nan", "segments", "1,2,3,4\nnan,2,3,4\n", "f:2",
            "found \"nan\", expected a finite number as x1");
        row("nan in the first line", "segments", "NaN,2,3,4\n", "f:1", "a finite number as x1");
        row("infinite", "segments", "1,-inf,3,4\n", "f:1", "a finite number as y1");
        row("too large", "points", "1,1e999\n", "f:1", "a finite number as y");
        row("a word", "points", "1,2\n3,four\n", "f:2", "found \"four\"");
        row("half a number", "points", "1,2\n3,4x\n", "f:2", "found \"4x\"");
        row("decimal comma", "points", "1,5,2,5\n", "f:1", "4 fields and no header");
        row("one field", "points", "1,2\n3\n", "f:2", "1 field, expected 2 fields");
        row("missing column", "points", "x,z\n1,2\n", "f:1", "no column y, expected columns x,y");
        row("empty field", "points", "1,2\n3,\n", "f:2", "found \"\"");
        row("binary", "points", QByteArray("1,2\n\0\0\n", 7), "f:2", "a NUL byte");
        row("missing coordinate", "segments", "x1,y1,x2\n1,2,3\n", "f:1", "no column y2");
        row("too few", "segments", "1,2,3\n", "f:1", "no column y2");
        row("truncated row", "segments", "1,2,3,4\n5,6,7\n", "f:2", "3 fields, expected 4");
        row("no pair", "pairs", "sx1,sy1,sx2,sy2,dx1,dy1,dx2,dy2\n", "f:1", "at least one pair");
        row("no length", "pairs", "0,0,0,0,5,5,6,5\n", "f:1", "a segment of no length");
        row("weight 0", "pairs", pairRow + ",0\n", "f:1", "a weight above 0");
        row("ten fields", "pairs", pairRow + ",1,2\n", "f:1", "10 fields and no header");
        row("half an id", "map",
            "id,x1,y1,x2,y2,n,sigma,observations,mean_x,mean_y,xx,xy,yy\n0.5,0,0,1,0,2,0,1,0,0,1,0,1\n",
            "f:2", "whole numbers from 0");
        row("negative sum", "map",
            "id,x1,y1,x2,y2,n,sigma,observations,mean_x,mean_y,xx,xy,yy\n5,0,0,1,0,2,0,1,0,0,-1,0,1\n", "f:2",
            "numbers from 0");
        row("a map without sums", "map", "id,x1,y1,x2,y2,n,sigma,observations\n5,0,0,1,0,2,0,1\n", "f:1",
            "no column mean_x");
        row("fewer points than announced", "pcd", pcdHeader + "POINTS 2\nDATA ascii\n9 9 1 2\n", "f:12",
            "2 points as the header");
        row("more points than announced", "pcd", pcdHeader + "POINTS 1\nDATA ascii\n9 9 1 2\n9 9 1 2\n",
            "f:13", "1 points");
        row("huge number of points", "pcd", pcdHeader + "POINTS 999999999999999999999\n", "f:10",
            "a count as POINTS");
        row("binary pcd", "pcd", pcdHeader + "POINTS 2\nDATA binary\n", "f:11", "DATA ascii");
        row("pcd without y", "pcd", "FIELDS x z\nPOINTS 1\nDATA ascii\n", "f:3", "fields x and y");
        row("pcd with a word", "pcd", pcdHeader + "POINTS 1\nDATA ascii\n9 9 none 2\n", "f:12",
            "a number as x");
        row("map beyond UTM", "map",
            "id,x1,y1,x2,y2,n,sigma,observations,mean_x,mean_y,xx,xy,yy\n5,0,1.2e7,1,0,2,0,1,0,0,1,0,1\n",
            "f:2", "a coordinate beyond 11,000 km");
        row("pcd with a field of no numbers", "pcd", "FIELDS y x\nCOUNT 1 0\nPOINTS 1\nDATA ascii\n5\n",
            "f:2", "a count as COUNT");
        row("beyond all floats", "float points", "1,2\n1e39,3\n", "f:2", "a coordinate beyond all measure");
        row("pcd beyond all floats", "float pcd", pcdHeader + "POINTS 1\nDATA ascii\n9 9 1 1e39\n", "f:12",
            "a coordinate beyond all measure");
        row("segment beyond all numbers", "segments", "0,0,1,1\n1e308,0,-1e308,0\n", "f:2",
            "a segment beyond all measure");
        row("pcd cut in the header", "pcd", pcdHeader, "f:9", "a line DATA");
    }
    void badInput() {
        FETCH(QByteArray, kind, QByteArray, text, QByteArray, place, QByteArray, said);
        const auto [rows, message] = outcome(kind, text);
        QCOMPARE(rows, -1);
        QVERIFY2(message.startsWith(place + ':'), message.constData());
        QVERIFY2(message.contains(said), message.constData());
    }

    void furtherColumnsAreKept() {
        std::istringstream in("room,x1,y1,x2,y2,colour\nhall,1,2,3,4,red\n");
        const auto table = readCsvSegments(in, "f");
        QCOMPARE(table->segments[0].end().y, 4.0);
        QVERIFY(table->furtherNames == (std::vector<std::string>{"room", "colour"}));
        QVERIFY(table->further[0] == (std::vector<std::string>{"hall", "red"}));
    }

    /// What earlier versions wrote, with all digits, and what a later one may write, with columns that this
    /// one does not know, in any order.
    void mapsOfOtherVersionsAreRead() {
        const char *const texts[] = {
            "id,x1,y1,x2,y2,n,sigma,observations,mean_x,mean_y,xx,xy,yy\n"
            "7,1.0000004321,2,4,2.0000001234,31,0.0098765432109,3,2.5,2.0000004,23.25123456789,0."
            "001234567891,0.003\n",
            "id,kind,x1,y1,x2,y2,n,sigma,observations,mean_x,mean_y,xx,xy,yy,seen\n"
            "7,1,1.000000,2,4,2.000000,31,0.009877,3,2.5,2.000000,23.251235,0.001235,0.003,1795500000\n"};
        for (const char *const text : texts) {
            std::istringstream in(text);
            const auto map = readMapCsv(in, "f");
            QVERIFY2(map.ok(), text);
            QCOMPARE(map->size(), std::size_t(1));
            const MapEdge &edge = map->front();
            QCOMPARE(edge.id, decltype(edge.id)(7));
            QCOMPARE(edge.observations, 3);
            QVERIFY(std::abs(edge.segment.begin().x - 1) < 1e-6 && std::abs(edge.segment.end().y - 2) < 1e-6);
            QVERIFY(std::abs(edge.sigma - 0.009877) < 1e-6 && std::abs(edge.sums.xx - 23.251235) < 1e-6);
        }
    }

    /// What was written is read back as exactly as it means something, and is written again as it stood.
    void mapComesBack() {
        std::mt19937 random(7);
        std::uniform_real_distribution<double> number(-1e4, 1e4);
        std::vector<MapEdge> map;
        for (int i = 0; i < 200; ++i) {
            MapEdge m;
            m.id = i * 3;
            m.segment = {{number(random), number(random)}, {number(random), number(random)}};
            m.sums = {double(i + 2),
                      {number(random), number(random) * 1e-9},
                      std::abs(number(random)),
                      number(random) / 3,
                      std::abs(number(random)) * 1e-15};
            m.sigma = std::abs(number(random)) / 7;
            m.observations = i;
            map.push_back(m);
        }
        std::stringstream text;
        writeMapCsv(text, map);
        const std::string written = text.str();
        QVERIFY(written.rfind("id,x1,y1,x2,y2,n,sigma,observations,", 0) == 0);
        const auto back = readMapCsv(text, "f");
        QVERIFY(back && back->size() == map.size());
        for (std::size_t i = 0; i < map.size(); ++i) {
            const MapEdge &a = map[i], &b = (*back)[i];
            const double micrometre = 1e-6, square = 1e-8 * a.sums.n;
            QVERIFY(a.id == b.id && a.observations == b.observations && a.sums.n == b.sums.n);
            QVERIFY(std::abs(a.sigma - b.sigma) < micrometre);
            QVERIFY((a.segment.begin() - b.segment.begin()).norm() < micrometre);
            QVERIFY((a.segment.end() - b.segment.end()).norm() < micrometre);
            QVERIFY((a.sums.mean - b.sums.mean).norm() < micrometre);
            for (const auto moment : {&TlsSums::xx, &TlsSums::xy, &TlsSums::yy})
                QVERIFY(std::abs(a.sums.*moment - b.sums.*moment) <= square);
        }
        std::ostringstream again;
        writeMapCsv(again, *back);
        QVERIFY(again.str() == written);
    }
};
