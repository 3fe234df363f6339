#include "NmeaText.h"
#include "protocol/nmea/SentenceParser.h"

using namespace hermes::nmea;

/// The bodies of the sentences in the bytes.
static QList<QByteArray> sentencesOf(SentenceParser &parser, const QByteArray &bytes) {
    QList<QByteArray> bodies;
    for (const char byte : bytes) {
        if (parser.feed(byte) == SentenceParser::Result::Done)
            bodies.append(toBytes(parser.sentence().body()));
    }
    return bodies;
}

class TestSentenceParser : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void findsSentences_data() {
        const Rows<QByteArray, QList<QByteArray>> row("bytes", "bodies");
        const QList<QByteArray> one{"GPTXT,A"};
        row("usual", "$GPTXT,A*22\r\n", one);
        row("lower case", "$GPTXT,o*0c\n", {"GPTXT,o"});
        row("only LF", "$GPTXT,A*22\n", one);
        row("only CR", "$GPTXT,A*22\r", one);
        row("noise before", "xx\xff,4*1\r\n$GPTXT,A*22\r\n", one);
        row("cut short", "$GPTXT,$GPTXT,A*22\r\n", one);
        row("damaged", "$GPTXT,B*22\r\n$GPTXT,A*22\r\n", one);
        row("no end yet", "$GPTXT,A*22", QList<QByteArray>());
        row("no line end between", "$GPTXT,A*22$GPTXT,A*22\r", one + one);
        row("binary behind", "$GPTXT,A*22\xb5\x62\r", one);
        row("a star inside", "$GPTXT,A*220,1*22\r\n", QList<QByteArray>());
        row("blank behind", "$GPTXT,A*22 \r\n", one);
        row("doubled start", "$$GPTXT,A*22\r\n", one);
        row("one digit", "$GPTXT,A*2\r\n", QList<QByteArray>());
        row("three digits", "$GPTXT,A*220\r\n", QList<QByteArray>());
        row("no digits", "$GPTXT,A*2G\r\n$GPTXT,A*G2\r\n$GPTXT,A*-2\r\n$*\r\n", QList<QByteArray>());
        row("NUL inside", QByteArray("$GPTXT,\0A*22\r\n", 14), QList<QByteArray>());
        row("encapsulated", "!AIVDM,A*3A\r\n", {"AIVDM,A"});
        row("empty", "$*00\r\n$\r\n\r\n", {""});
    }

    void findsSentences() {
        FETCH(QByteArray, bytes, QList<QByteArray>, bodies);
        SentenceParser parser;
        QCOMPARE(sentencesOf(parser, bytes), bodies);
        QCOMPARE(parser.counts().sentences, quint64(bodies.size()));
    }

    void aPieceEndsASentence() {
        SentenceParser parser;
        QCOMPARE(sentencesOf(parser, "$GPTXT,A*22").size(), 0);
        QCOMPARE(parser.endPiece(), SentenceParser::Result::Done);
        QCOMPARE(toBytes(parser.sentence().body()), QByteArray("GPTXT,A"));
        for (const char *begun :
             {"\r\n", "$", "$GPTXT", "$GPTXT,A*", "$GPTXT,A*2", "$GPTXT,A*23"}) { // more may come
            QCOMPARE(sentencesOf(parser, begun).size(), 0);
            QCOMPARE(parser.endPiece(), SentenceParser::Result::Incomplete);
        }
        QCOMPARE(parser.counts().sentences, quint64(1));
        parser.reset();
        QCOMPARE(sentencesOf(parser, "$GPTXT,A*2").size(), 0);
        parser.endPiece();
        QCOMPARE(sentencesOf(parser, "2\n").size(), 1);
    }

    void countsWhatItDrops() {
        SentenceParser parser;
        const QByteArray endless = "$GPTXT," + QByteArray(int(maxSentence) * 3, 'A');
        QCOMPARE(sentencesOf(parser, endless + "\n$GPTXT,\x80XT\n$GPTXT,$GPTXT,A*23\n$GPTXT,A\n").size(), 0);
        const SentenceParser::Counts &counts = parser.counts();
        QCOMPARE(counts.tooLong, quint64(1));
        QCOMPARE(counts.badByte, quint64(1));
        QCOMPARE(counts.cutShort, quint64(1));
        QCOMPARE(counts.badChecksum, quint64(1));
        QCOMPARE(counts.noChecksum, quint64(1));
        // The endless one is dropped with the byte that is too much; behind it and behind 0x80 all is noise.
        QCOMPARE(counts.skippedBytes, quint64(endless.size()) - maxSentence - 1 + 2);
        QCOMPARE(sentencesOf(parser, realRmc).size(), 1);
        // Binary messages between sentences are no sentences.
        const SentenceParser::Counts before = counts;
        const QByteArray binary("\xb5\x62$\x01!AB,\x02$GP,\x03$\n$Gp123,4\n$*12\n", 27);
        QCOMPARE(sentencesOf(parser, binary + realRmc).size(), 1);
        QCOMPARE(counts.badByte + counts.cutShort + counts.noChecksum + counts.badChecksum,
                 before.badByte + before.cutShort + before.noChecksum + before.badChecksum);
        QVERIFY(counts.skippedBytes > before.skippedBytes + 15);
    }

    void isInStepWhereverItBegins() {
        const QByteArray two = realRmc + usualGga;
        for (int begin = 1; begin < realRmc.size(); ++begin) {
            SentenceParser parser;
            const auto bodies = sentencesOf(parser, two.mid(begin));
            QCOMPARE(bodies.size(), 1);
            QVERIFY(bodies[0].startsWith("GPGGA,"));
        }
        // Any single bit that is wrong costs that sentence at most, and never passes unseen.
        for (int bit = 0; bit < realRmc.size() * 8; ++bit) {
            QByteArray damaged = two;
            damaged[bit / 8] = char(damaged[bit / 8] ^ (1 << bit % 8));
            SentenceParser parser;
            for (const QByteArray &body : sentencesOf(parser, damaged))
                QVERIFY2(two.contains('$' + body + '*') || body.isEmpty(), body.constData());
        }
    }

    void withoutChecksumOnlyWhenLenient() {
        SentenceParser strict, lenient(ChecksumRule::Lenient);
        const QByteArray bytes("$GPTXT,A\r\n$GPTXT,B*22\r\n");
        QCOMPARE(sentencesOf(strict, bytes).size(), 0);
        QCOMPARE(sentencesOf(lenient, bytes), QList<QByteArray>{"GPTXT,A"});
        QCOMPARE(strict.counts().noChecksum, quint64(1));
        QCOMPARE(lenient.counts().badChecksum, quint64(1)); // a wrong one is refused all the same
    }

    void splitsFields() {
        const Sentence sentence("GNGSA,A,,3,");
        QCOMPARE(toBytes(sentence.address()), QByteArray("GNGSA"));
        QCOMPARE(toBytes(sentence.type()), QByteArray("GSA"));
        QCOMPARE(sentence.fieldCount(), 4);
        QCOMPARE(toBytes(sentence.field(1)), QByteArray("A"));
        QCOMPARE(toBytes(sentence.field(3)), QByteArray("3"));
        for (const int empty : {2, 4, 5, 100})
            QVERIFY(sentence.field(empty).empty());
        QVERIFY(Sentence("PMTK001,1").type().empty());
        QVERIFY(Sentence("PGRME").type().empty());
    }
};
