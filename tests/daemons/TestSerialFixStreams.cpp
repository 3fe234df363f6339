#include "tests/daemons/NmeaStream.h"

using namespace hermes;
using namespace hermes::seriallogger;

constexpr double day_s = 1893456000; // 2030-01-01
constexpr double knot = 1852.0 / 3600;

/// What was true at a moment, and what of it reached the logger.
struct Truth {
    double time = 0;
    bool hasFix = true;
    int latitude = 0, longitude = 0; // 0.0001 minutes
    int speed = 0;                   // 0.1 knots
    int altitude = 0;                // 0.1 m
    // What reached the logger.
    bool told = false, motion = false, height = false, date = false;
};

struct Part {
    int ms = 0; ///< when it comes in
    QByteArray bytes;
};

/// A made-up receiver with habits of its own, and a bad line behind it. The seed decides on all.
class DrawnStream {
public:
    explicit DrawnStream(unsigned seed)
        : random_(seed) {
        rate_hz_ = pick({1, 1, 2, 5, 10, 20});
        pauses_ = chance(0.7);
        loss_ = chance(0.4) ? 0 : real(0, 0.3);
        drawOrder();
        decimals_ = rate_hz_ > 1 ? 2 : pick({0, 1, 2, 3});
        moment_.time = day_s + pick({43200, 86390, 86400 * 58 + 86397}) + pick({0, 1, 2});
        moment_.latitude = pick({0, 1, 28999999, 53990000});
        moment_.longitude = pick({0, 6750000, 107999999});
        for (int i = 0; i < 60; ++i)
            drawMoment(i);
    }

    QList<Truth> moments;
    QList<Part> parts;
    bool isLossless() const { return loss_ == 0; }
    int damaged = 0, wrong = 0, whole = 0;

private:
    template <typename T>
    T pick(std::initializer_list<T> values) {
        return *(values.begin() + std::uniform_int_distribution<std::ptrdiff_t>(
                                      0, std::ptrdiff_t(values.size()) - 1)(random_));
    }
    double real(double least, double most) { return std::uniform_real_distribution<>(least, most)(random_); }
    bool chance(double share) { return real(0, 1) < share; }

    void drawOrder() {
        const auto add = [this](double share, const char *address) {
            if (chance(share))
                order_ << address;
        };
        add(0.7, "GPRMC");
        add(0.6, "GPGGA");
        add(0.3, "GLGGA");
        add(0.3, "GNGNS");
        add(0.3, "GPGLL");
        if (order_.isEmpty())
            order_ << "GNGLL";
        std::shuffle(order_.begin(), order_.end(), random_);
        // Without pauses nothing tells a VTG of a lost moment, or that it belongs to what comes behind it.
        const bool seesPauses = pauses_ && rate_hz_ <= 10;
        if (chance(0.5) && (seesPauses || isLossless()))
            order_.insert(pick({seesPauses ? 0 : 1, int(order_.size())}), "GPVTG");
        if (chance(0.4))
            order_.insert(pick({0, int(order_.size())}), "GPZDA");
        for (const char *other : {"GPGSV", "GPGSA", "PUBX"})
            if (chance(0.5))
                order_.insert(pick({0, int(order_.size())}), other);
    }

    QByteArray angle(int value, int width, const char *signs) {
        const int size = std::abs(value);
        return QByteArray::number(size / 600000).rightJustified(width, '0') +
               QByteArray::number(size % 600000 / 1e4, 'f', 4).rightJustified(7, '0') + ',' +
               signs[value < 0];
    }
    QByteArray position() {
        if (!moment_.hasFix)
            return pick<QByteArray>({",,,", ",N,,E"});
        return angle(moment_.latitude, 2, "NS") + ',' + angle(moment_.longitude, 3, "EW");
    }
    QByteArray body(const QByteArray &address) {
        const auto clock = nmea::timeOf(moment_.time).value();
        const auto date = nmea::dateOf(moment_.time).value();
        const auto two = [](int value) { return QByteArray::number(value).rightJustified(2, '0'); };
        const QByteArray time = two(clock.hour) + two(clock.minute) +
                                QByteArray::number(clock.second, 'f', decimals_)
                                    .rightJustified(decimals_ ? decimals_ + 3 : 2, '0');
        const QByteArray knots = QByteArray::number(moment_.speed / 10.0, 'f', 1);
        const QByteArray type = address.mid(2), status = moment_.hasFix ? "A" : "V";
        if (type == "RMC")
            return address + ',' + time + ',' + status + ',' + position() + ',' + knots + ",84.4," +
                   two(date.day) + two(date.month) + two(date.year % 100) + ',' +
                   pick({"999.9,,A", "3.1,W,A", "3.1,W", ",,N", "x,y,z,V"});
        if (type == "GLL")
            return address + ',' + position() + ',' + time + ',' + status + ",A";
        if (type == "VTG")
            return address + ",84.4,T,999.9,M," + knots + ",N,,K,A";
        if (type == "ZDA")
            return address + ',' + time + ',' + two(date.day) + ',' + two(date.month) + ',' +
                   QByteArray::number(date.year) + ",00,00";
        const QByteArray height = ",8,0.9," + QByteArray::number(moment_.altitude / 10.0, 'f', 1);
        if (type == "GGA")
            return address + ',' + time + ',' + position() + ',' + (moment_.hasFix ? "2" : "0") + height +
                   pick({",M,46.9,M,,", ",M,,M,x,STATION"});
        if (type == "GNS")
            return address + ',' + time + ',' + position() + ',' + (moment_.hasFix ? "NAD" : "NNN") + height +
                   ",46.9,,,V";
        return address + ",1,2,3";
    }

    void told(const QByteArray &address) {
        const QByteArray type = address.mid(2);
        moment_.told = moment_.told || type == "RMC" || type == "GGA" || type == "GNS" || type == "GLL";
        moment_.motion = moment_.motion || type == "RMC" || type == "VTG";
        moment_.height = moment_.height || type == "GGA" || type == "GNS";
        moment_.date = moment_.date || type == "RMC" || type == "ZDA";
    }

    QByteArray drawSentence(const QByteArray &address) {
        const QByteArray good = sentence(body(address));
        if (chance(loss_)) {
            if (chance(0.3))
                return {};
            if (chance(0.3) && moment_.hasFix && !address.endsWith("SV") && !address.endsWith("SA") &&
                address != "PUBX" && !address.endsWith("ZDA") && !address.endsWith("VTG")) {
                ++wrong;
                ++whole;
                QByteArray text = body(address);
                text.replace(angle(moment_.latitude, 2, "NS"), "9000.0001,N");
                return sentence(text);
            }
            QByteArray bad = good;
            const int at = std::uniform_int_distribution<>(1, good.indexOf('*') - 1)(random_);
            damaged += at > good.indexOf(','); // what has no address is no sentence
            bad[at] = char(bad[at] ^ 1 << pick({0, 1, 2, 3, 4, 5, 6, 7}));
            if (bad[at] == '$') // the rest of one in 256 would pass for a sentence
                bad[at] = '#';
            return bad;
        }
        told(address);
        const int times = chance(0.1) ? 2 : 1;
        whole += times;
        return good.repeated(times);
    }

    void drawMoment(int number) {
        int steps = 1;
        if (chance(0.03))
            steps = pick({2, 17, rate_hz_ * 3600});
        else if (number > 5 && pauses_ && chance(0.03))
            // Its clock is set right. Where no pause is seen, or all between was lost, a time told again soon
            // would pass for a repetition.
            steps = rate_hz_ > 10 || !isLossless() ? -7 * rate_hz_ : pick({-1, -7});
        moment_.time = std::round((moment_.time + double(steps) / rate_hz_) * 1000) / 1000;
        moment_.hasFix = moment_.hasFix ? !chance(0.05) : chance(0.3);
        moment_.latitude += number % 2 ? -1234 : 1233;
        moment_.longitude -= 321;
        moment_.speed = 10 * number + pick({1, 2, 3});
        moment_.altitude = 10 * number - 55;
        moment_.told = moment_.motion = moment_.height = moment_.date = false;
        const double loss = std::exchange(loss_, number < 3 ? 0 : loss_); // the rate must be seen first
        if (!pauses_ || chance(1 - loss_ / 3)) {
            const int begin = pauses_ ? number * 1000 / rate_hz_ : 0;
            const int most = pauses_ ? std::min(20, 200 / rate_hz_) : 0;
            int ms = begin;
            for (const QByteArray &address : order_) {
                const QByteArray text = drawSentence(address);
                const int cut = std::uniform_int_distribution<>(0, text.size())(random_);
                parts << Part{ms, text.left(cut)};
                ms = std::min(begin + most, ms + pick({0, 1, 5}) * (pauses_ ? 1 : 0));
                parts << Part{ms, text.mid(cut)};
            }
        }
        loss_ = loss;
        moments << moment_;
    }

    std::mt19937 random_;
    int rate_hz_ = 1;
    bool pauses_ = true;
    double loss_ = 0; ///< share of the sentences
    int decimals_ = 0;
    QByteArrayList order_;
    Truth moment_;
};

static NmeaStream played(const DrawnStream &drawn, bool live) {
    NmeaStream stream;
    stream.live = live;
    for (const Part &part : drawn.parts)
        if (!part.bytes.isEmpty())
            stream.feed(part.ms, part.bytes);
    stream.finish();
    return stream;
}

/// Receivers of any habits on bad lines: each moment that reached the logger gives one fix, with what is
/// true; what a fix lacks is counted.
class TestSerialFixStreams : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void everyMomentGivesOneFix_data() {
        const Rows<unsigned> row("seed");
        row("the same each time", 1U);
        row("others each time", std::random_device()());
    }

    void everyMomentGivesOneFix() {
        QFETCH(unsigned, seed);
        for (unsigned i = 0; i < 400; ++i) {
            check(seed + i);
            if (QTest::currentTestFailed()) {
                qInfo("seed %u", seed + i);
                return;
            }
        }
    }

private:
    void check(unsigned seed) {
        const DrawnStream drawn(seed);
        const NmeaStream stream = played(drawn, true);
        QCOMPARE(played(drawn, false).fixes, stream.fixes); // a recording gives what was shown
        quint64 lacking = 0;
        int next = 0;
        bool dateKnown = false;
        for (const Truth &moment : drawn.moments) {
            if (moment.told) {
                QVERIFY(next < stream.fixes.size());
                const QJsonObject &fix = stream.fixes[next++];
                QCOMPARE(fix.value("valid").toBool(), moment.hasFix);
                QVERIFY(!fix.value("time").isNull() || !dateKnown);
                if (!fix.value("time").isNull())
                    QVERIFY2(std::abs(fix.value("time").toDouble() - moment.time) < 1e-5,
                             saying(fix.value("time").toDouble() - moment.time));
                if (moment.hasFix) {
                    QVERIFY(std::abs(fix.value("lat_deg").toDouble() - moment.latitude / 6e5) < 1e-9);
                    QVERIFY(std::abs(fix.value("lon_deg").toDouble() - moment.longitude / 6e5) < 1e-9);
                }
                lacking += moment.motion && fix.value("speed").isNull();
                lacking += moment.height && fix.value("alt").isNull();
                if (!fix.value("speed").isNull())
                    QVERIFY(std::abs(fix.value("speed").toDouble() - moment.speed / 10.0 * knot) < 1e-9);
                if (!fix.value("alt").isNull())
                    QVERIFY(std::abs(fix.value("alt").toDouble() - moment.altitude / 10.0) < 1e-9);
            }
            dateKnown = dateKnown || moment.date;
        }
        QCOMPARE(stream.fixes.size(), next);
        const FixTracker::Counts &counts = stream.tracker.counts();
        QVERIFY(lacking <= counts.late);
        QVERIFY(!drawn.isLossless() || lacking == 0);
        QCOMPARE(int(counts.badFields), drawn.wrong);
        const nmea::SentenceParser::Counts &sentences = stream.tracker.sentences();
        QCOMPARE(int(sentences.sentences), drawn.whole);
        QVERIFY(int(sentences.badChecksum + sentences.noChecksum + sentences.tooLong + sentences.badByte +
                    sentences.cutShort) >= drawn.damaged);
    }
};
