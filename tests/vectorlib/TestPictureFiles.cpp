#include <vectorlib/io/MapDrawing.h>
#include <vectorlib/io/Pgm.h>
#include <vectorlib/io/Svg.h>
#include <vectorlib/io/Tum.h>

#include <QXmlStreamReader>

using namespace vectorlib;

static std::vector<MapEdge> corner() {
    std::vector<MapEdge> map(2);
    map[0].id = 4;
    map[0].segment = {{0, 0}, {2, 0}};
    map[1].id = 5;
    map[1].segment = {{2, 0}, {2, 1.5}};
    return map;
}

static QByteArray written(SvgPicture &picture) {
    std::ostringstream out;
    picture.write(out);
    return QByteArray::fromStdString(out.str());
}

/// Elements and text of an SVG file; fails the test when it is not well-formed.
static QByteArray contents(const QByteArray &svg) {
    QXmlStreamReader xml(svg);
    QByteArray seen;
    while (!xml.atEnd())
        if (xml.readNext() == QXmlStreamReader::StartElement)
            seen += '<' + xml.name().toUtf8() + '>';
        else if (xml.isCharacters())
            seen += xml.text().toUtf8();
    return xml.hasError() ? "malformed: " + xml.errorString().toUtf8() : seen;
}

/// Pictures and drawings of maps in the formats of other programs.
class TestPictureFiles : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void svgHasLegendScaleAndLayers() {
        SvgPicture picture("Room <1> & hall");
        picture.segments<double>({colour::map, 2, "walls & doors"}, {{{0, 0}, {8, 0}}, {{8, 0}, {8, 6}}});
        picture.points<float>({colour::points, 3, "points"}, {{1, 1}, {2, 2}});
        picture.path({colour::estimate, 1, "trajectory", true}, {{1, 1}, {2, 3}});
        picture.pose({colour::reference, 2, "sensor"}, {1, 1}, 0.5);
        const QByteArray svg = contents(written(picture));
        for (const char *part :
             {"Room <1> & hall", "walls & doors", "points", "trajectory", "sensor", "1 m", "<circle>"})
            QVERIFY2(svg.contains(part), svg.constData());
    }
    void svgOfNothingAndOfNonsense() {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        SvgPicture empty("empty"), wild("wild");
        wild.points<double>({colour::points, 1, "p"}, {{nan, 0}, {1, 1}});
        wild.segments<double>({colour::map, 1, "s"}, {{{0, nan}, {1, 1}}});
        for (SvgPicture *picture : {&empty, &wild}) {
            const QByteArray svg = written(*picture);
            QVERIFY(!contents(svg).startsWith("malformed"));
            QVERIFY2(!svg.contains("nan") && !svg.contains("inf"), svg.constData());
        }
    }

    // Where a line of the grid and the next are the same number there is still an end of them.
    void svgFarFromTheOrigin() {
        SvgPicture far("far");
        far.points<double>({colour::points, 1, "p"}, {{1e17, -1e17}, {1e17 + 16, -1e17}});
        const QByteArray svg = written(far);
        QVERIFY(!contents(svg).startsWith("malformed"));
        QVERIFY(svg.count("<path") < 30);
    }

    void geoJson() {
        std::ostringstream out;
        writeGeoJson(out, corner());
        const QJsonArray features = QJsonDocument::fromJson(QByteArray::fromStdString(out.str()))
                                        .object()
                                        .value("features")
                                        .toArray();
        QCOMPARE(features.size(), 2);
        const QJsonObject second = features[1].toObject();
        QCOMPARE(second["id"].toInt(), 5);
        QCOMPARE(second["geometry"].toObject()["coordinates"].toArray()[1].toArray()[1].toDouble(), 1.5);
    }

    void dxf() {
        std::ostringstream out;
        writeDxf(out, corner());
        const QByteArray text = QByteArray::fromStdString(out.str());
        QCOMPARE(text.count("\nLINE\n"), 2);
        QVERIFY(text.contains("10\n2\n20\n0\n30\n0\n11\n2\n21\n1.5\n"));
        QVERIFY(text.endsWith("0\nEOF\n"));
    }

    void tum() {
        std::ostringstream out;
        writeTum(out, {{1234567890.125, {1, -2.5, pi}}});
        QCOMPARE(QByteArray::fromStdString(out.str()).left(32),
                 QByteArray("1234567890.125 1 -2.5 0 0 0 1 6."));
    }

    void tumStampsAscend_data() {
        const Rows<QList<double>, QList<QByteArray>, int, int, double> row("stamps", "written", "ties",
                                                                           "stepsBack", "farthest");
        row("none", {}, {}, 0, 0, 0.0);
        row("ascending", {-1, 0, 0.25, 7}, {"-1", "0", "0.25", "7"}, 0, 0, 0.0);
        row("tie", {0, 1, 1, 2}, {"0", "1", "1.000001", "2"}, 1, 0, 1e-6);
        row("step back", {0, 4, 2, 3, 3, 7}, {"0", "4", "4.000001", "4.000002", "4.000003", "7"}, 1, 1,
            2.000001);
        row("a mended one is passed again", {1, 1, 1.0000005, 1.000003},
            {"1", "1.000001", "1.000002", "1.000003"}, 1, 0, 1.5e-6);
    }
    void tumStampsAscend() {
        QFETCH(QList<double>, stamps);
        std::vector<StampedPose> trajectory;
        for (const double stamp : stamps)
            trajectory.push_back({stamp, {}});
        std::ostringstream out;
        const StampMend mend = writeTum(out, trajectory);
        QList<QByteArray> written;
        for (const QByteArray &line : QByteArray::fromStdString(out.str()).split('\n'))
            if (!line.isEmpty())
                written << line.split(' ')[0];
        QTEST(written, "written");
        QTEST(int(mend.ties), "ties");
        QTEST(int(mend.stepsBack), "stepsBack");
        QFETCH(double, farthest);
        QVERIFY(std::abs(mend.farthest - farthest) < 1e-9);
        int moved = 0;
        for (int i = 0; i < stamps.size(); ++i)
            moved += written[i].toDouble() != stamps[i];
        QCOMPARE(int(mend.moved), moved);
    }
    /// A log that lost its digits; and one whose stamps are so far out that a microsecond is no number.
    void tumStampsAscendInAnyDigits() {
        for (const double stamp : {0.0, 1.01893e9, 1234567890.1234567, -3e15, 9e17}) {
            std::ostringstream out;
            QCOMPARE(writeTum(out, std::vector<StampedPose>(3000, {stamp, {}})).ties, std::size_t(2999));
            double last = -INFINITY;
            QSet<QByteArray> microseconds;
            for (const QByteArray &line : QByteArray::fromStdString(out.str()).trimmed().split('\n')) {
                QVERIFY(line.split(' ')[0].toDouble() > last);
                last = line.split(' ')[0].toDouble();
                microseconds.insert(QByteArray::number(last, 'f', 6));
            }
            QCOMPARE(microseconds.size(), 3000); // for programs that round to them
        }
    }

    void occupancy() {
        const auto picture = OccupancyPicture::draw(corner(), {{0, {1, 0.5, 0}}, {1, {1, 1, 0}}}, 0.1);
        QVERIFY(picture.has_value());
        std::ostringstream pgm, yaml;
        picture->writePgm(pgm);
        picture->writeYaml(yaml, "a.pgm");
        const std::string cells = pgm.str();
        QVERIFY(cells.rfind("P5\n40 35\n255\n", 0) == 0); // 2 m x 1.5 m and 1 m around
        const auto cell = [&](double x, double y) {
            const int column = int((x + 1) / 0.1), row = 34 - int((y + 1) / 0.1);
            return int(static_cast<unsigned char>(cells[13 + std::size_t(row * 40 + column)]));
        };
        QCOMPARE(cell(1.05, 0.02), 0);   // wall
        QCOMPARE(cell(1.05, 0.72), 254); // driven
        QCOMPARE(cell(0.25, 1.25), 205); // never seen
        QVERIFY(yaml.str().find("image: a.pgm\nresolution: 0.1\norigin: [-1, -1, 0]") == 0);
    }
    void pictureNamesAreQuoted_data() {
        const Rows<QByteArray, QByteArray> row("name", "quoted");
        row("plain", "my-map_2.pgm", "my-map_2.pgm");
        row("number sign", "x #2.pgm", "\"x #2.pgm\"");
        row("colon", "a: b.pgm", "\"a: b.pgm\"");
        row("list", "[1].pgm", "\"[1].pgm\"");
        row("quotes", "'q' \"r\".pgm", "\"'q' \\U00000022r\\U00000022.pgm\"");
        row("back slash", "a\\b.pgm", "\"a\\U0000005cb.pgm\"");
        row("dash", "- a.pgm", "\"- a.pgm\"");
        row("line end", "a\nb.pgm", "\"a\\U0000000ab.pgm\"");
        row("beyond ASCII", "\xC3\xBC\xF0\x9F\x98\x80.pgm", "\"\\U000000fc\\U0001f600.pgm\"");
    }
    void pictureNamesAreQuoted() {
        FETCH(QByteArray, name, QByteArray, quoted);
        std::ostringstream yaml;
        OccupancyPicture::draw(corner(), {})->writeYaml(yaml, name.toStdString());
        QCOMPARE(QByteArray::fromStdString(yaml.str()).split('\n')[0], "image: " + quoted);
    }
    void hugeMapsAreNotDrawn() {
        std::vector<MapEdge> map(1);
        map[0].segment = {{0, 0}, {1e7, 1e7}};
        QVERIFY(!OccupancyPicture::draw(map, {}));
    }
};
