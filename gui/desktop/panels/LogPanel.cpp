#include "gui/desktop/panels/LogPanel.h"

#include "gui/desktop/Theme.h"

#include <QComboBox>
#include <QDateTime>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QVBoxLayout>

namespace hermes {
namespace {

const QStringList levels{"debug", "info", "warning", "error"};

QString colourOf(int level) {
    return level == 3   ? theme::colour(Condition::Fault).name()
           : level == 2 ? theme::colour(Condition::Warning).name()
                        : QString();
}

} // namespace

LogPanel::LogPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , level_(new QComboBox)
    , filter_(new QLineEdit)
    , view_(new QPlainTextEdit) {
    level_->setObjectName("level");
    level_->addItems({tr("all"), tr("info and above"), tr("warnings and errors"), tr("errors")});
    level_->setCurrentIndex(1);
    filter_->setObjectName("filter");
    filter_->setPlaceholderText(tr("Show only lines with this text"));
    filter_->setClearButtonEnabled(true);
    view_->setObjectName("records");
    view_->setReadOnly(true);
    view_->setFont(theme::fixedFont());
    view_->setLineWrapMode(QPlainTextEdit::NoWrap);
    view_->setMaximumBlockCount(int(maxRecords));
    view_->setPlaceholderText(tr("What the daemons log appears here."));

    auto *const top = new QHBoxLayout;
    auto *const label = new QLabel(tr("&Level"));
    label->setBuddy(level_);
    top->addWidget(label);
    top->addWidget(level_);
    top->addWidget(filter_, 1);
    auto *const layout = new QVBoxLayout(this);
    layout->addLayout(top);
    layout->addWidget(view_);

    connect(level_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, &LogPanel::refill);
    connect(filter_, &QLineEdit::textChanged, this, &LogPanel::refill);
    connect(&fleet, &Fleet::changed, this, &LogPanel::followAll);
    followAll();
}

void LogPanel::followAll() {
    for (const auto &robot : fleet_.robots())
        for (DaemonLink *daemon : robot->daemons())
            if (!followed_.contains(daemon) && daemon->hasTopic("log"))
                follow(daemon);
}

void LogPanel::follow(DaemonLink *daemon) {
    followed_.insert(daemon);
    connect(daemon, &QObject::destroyed, this, [this, daemon] { followed_.remove(daemon); });
    daemon->client().subscribe("log", {{"queue", 100}}, [this, daemon](const TopicUpdate &update) {
        add(daemon->name(), update.data.toObject());
    });
    daemon->call("log.tail", {{"count", 100}}, this, [this, name = daemon->name()](const auto &tail) {
        if (!tail)
            return;
        for (const QJsonValue &record : tail->toArray())
            add(name, record.toObject());
    });
}

void LogPanel::add(const QString &daemon, const QJsonObject &record) {
    const Record made{record["stamp"].toDouble(), daemon, levels.indexOf(record["level"].toString()),
                      record["source"].toString() + ": " + record["text"].toString()};
    const bool isNewest = records_.empty() || records_.back().stamp <= made.stamp;
    const auto after =
        std::upper_bound(records_.begin(), records_.end(), made.stamp,
                         [](double stamp, const Record &other) { return stamp < other.stamp; });
    records_.insert(after, made);
    if (records_.size() > maxRecords)
        records_.pop_front();
    if (!isNewest)
        refill();
    else if (passes(made))
        append(made);
}

bool LogPanel::passes(const Record &record) const {
    const QString text = filter_->text();
    return record.level >= level_->currentIndex() &&
           (text.isEmpty() || record.text.contains(text, Qt::CaseInsensitive) ||
            record.daemon.contains(text, Qt::CaseInsensitive));
}

void LogPanel::append(const Record &record) {
    const QString time = QDateTime::fromMSecsSinceEpoch(qint64(record.stamp * 1000)).toString("HH:mm:ss.zzz");
    const QString line = QString("%1  %2  %3  %4")
                             .arg(time, record.daemon.leftJustified(15),
                                  levels.value(record.level, "?").leftJustified(7), record.text);
    const QString colour = colourOf(record.level);
    view_->appendHtml(QString("<span style=\"white-space:pre%1\">%2</span>")
                          .arg(colour.isEmpty() ? QString() : ";color:" + colour, line.toHtmlEscaped()));
}

void LogPanel::refill() {
    view_->clear();
    for (const Record &record : records_)
        if (passes(record))
            append(record);
}

} // namespace hermes
