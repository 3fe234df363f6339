#include "gui/desktop/panels/PlotsPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/MessageLabel.h"

#include <QFileDialog>
#include <QGraphicsLayout>
#include <QHBoxLayout>
#include <QPushButton>
#include <QSaveFile>
#include <QSplitter>
#include <QTextStream>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <QtCharts/QChart>
#include <QtCharts/QChartView>
#include <QtCharts/QLegend>
#include <QtCharts/QLineSeries>
#include <QtCharts/QValueAxis>

namespace hermes::desktop {

using namespace QtCharts;

namespace {

constexpr int longestName = 60, mostTopics = 200, mostFields = 200;

enum Role { AddressRole = Qt::UserRole, TopicRole, PathRole, DaemonRole };

FieldId fieldOf(const QTreeWidgetItem &item) {
    return {item.data(0, AddressRole).toString(), item.data(0, TopicRole).toString(),
            item.data(0, PathRole).toString()};
}

DaemonLink *daemonOf(const QTreeWidgetItem &item) {
    return qobject_cast<DaemonLink *>(item.data(0, DaemonRole).value<QPointer<QObject>>());
}

} // namespace

PlotsPanel::PlotsPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , tree_(new QTreeWidget)
    , chart_(new QChart)
    , chartView_(new QChartView(chart_))
    , time_(new QValueAxis)
    , value_(new QValueAxis)
    , message_(new MessageLabel) {
    tree_->setObjectName("topics");
    tree_->setAccessibleName(tr("Topics and their numbers"));
    tree_->setHeaderHidden(true);
    tree_->setUniformRowHeights(true);
    chart_->setTheme(theme::isDark() ? QChart::ChartThemeDark : QChart::ChartThemeLight);
    chart_->setMargins({});
    chart_->setBackgroundRoundness(0);
    chart_->layout()->setContentsMargins(0, 0, 0, 0);
    chart_->legend()->setAlignment(Qt::AlignRight);
    QFont small = font();
    small.setPointSizeF(0.85 * small.pointSizeF());
    time_->setLabelsFont(small);
    value_->setLabelsFont(small);
    chart_->legend()->setFont(small);
    time_->setRange(-span_s, 0);
    time_->setLabelFormat(tr("%g s"));
    value_->setLabelFormat("%g");
    chart_->addAxis(time_, Qt::AlignBottom);
    chart_->addAxis(value_, Qt::AlignLeft);
    chartView_->setMinimumHeight(80);
    message_->tell(tr("Open a topic and tick a number to plot it."));

    auto *const left = new QWidget;
    auto *const column = new QVBoxLayout(left);
    column->setContentsMargins(0, 0, 0, 0);
    column->addWidget(tree_, 1);
    column->addWidget(message_);
    column->addWidget(makeButtons());
    auto *const splitter = new QSplitter;
    splitter->addWidget(left);
    splitter->addWidget(chartView_);
    splitter->setStretchFactor(1, 3);
    auto *const layout = new QVBoxLayout(this);
    layout->addWidget(splitter);

    connect(tree_, &QTreeWidget::itemExpanded, this, [this](QTreeWidgetItem *item) {
        if (item->parent() && item->childCount() == 0)
            listFields(daemonOf(*item), item->data(0, TopicRole).toString());
    });
    connect(tree_, &QTreeWidget::itemChanged, this, &PlotsPanel::onItemChanged);
    connect(&fleet, &Fleet::changed, this, &PlotsPanel::listTopics);
    connect(&timer_, &QTimer::timeout, this, &PlotsPanel::redraw);
    timer_.start(std::chrono::milliseconds(100));
    listTopics();
}

QWidget *PlotsPanel::makeButtons() {
    auto *const row = new QWidget;
    auto *const layout = new QHBoxLayout(row);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(pause_ = new QPushButton(theme::icon("pause"), tr("Pa&use")));
    auto *const save = new QPushButton(theme::icon("export"), tr("CSV"));
    layout->addWidget(save);
    pause_->setObjectName("pause");
    pause_->setCheckable(true);
    pause_->setToolTip(tr("The picture stands still; sampling goes on"));
    save->setObjectName("csv");
    save->setToolTip(tr("Writes the last ten minutes of all curves"));
    connect(save, &QPushButton::clicked, this, &PlotsPanel::askFile);
    return row;
}

QStringList PlotsPanel::plotted() const {
    QStringList fields;
    for (const auto &[field, curve] : curves_)
        fields.append(field.address + ' ' + field.topic + ' ' + field.path);
    for (const FieldId &field : wanted_)
        fields.append(field.address + ' ' + field.topic + ' ' + field.path);
    return fields;
}

void PlotsPanel::plot(const QStringList &fields) {
    for (const QString &field : fields)
        wanted_.insert({field.section(' ', 0, 0), field.section(' ', 1, 1), field.section(' ', 2)});
    listTopics();
}

// Daemons and topics that are new; what is listed once stays, so that curves do.
void PlotsPanel::listTopics() {
    isListing_ = true;
    for (const auto &robot : fleet_.robots())
        for (DaemonLink *daemon : robot->daemons()) {
            if (daemon->topics().isEmpty())
                continue;
            QTreeWidgetItem *item = nullptr;
            for (int i = 0; i < tree_->topLevelItemCount(); ++i)
                if (daemonOf(*tree_->topLevelItem(i)) == daemon)
                    item = tree_->topLevelItem(i);
            if (!item) {
                item = new QTreeWidgetItem(tree_, {daemon->name()});
                item->setData(0, DaemonRole, QVariant::fromValue(QPointer<QObject>(daemon)));
                item->setToolTip(0, daemon->address());
            }
            QSet<QString> listed;
            for (int i = 0; i < item->childCount(); ++i)
                listed.insert(item->child(i)->data(0, TopicRole).toString());
            for (const QString &topic : daemon->topics()) {
                if (item->childCount() >= mostTopics)
                    break;
                if (listed.contains(topic) || topic == "log" || topic == "settings")
                    continue;
                auto *const child = new QTreeWidgetItem(item, {shortLine(topic, longestName)});
                child->setData(0, TopicRole, topic);
                child->setData(0, DaemonRole, item->data(0, DaemonRole));
                child->setChildIndicatorPolicy(QTreeWidgetItem::ShowIndicator);
                const bool isWanted = std::any_of(wanted_.begin(), wanted_.end(), [&](const FieldId &field) {
                    return field.address == daemon->address() && field.topic == topic;
                });
                if (isWanted)
                    listFields(daemon, topic);
            }
            if (daemon->topics().size() > mostTopics)
                item->setText(0, tr("%1 (%2 topics, of which %3 are listed)")
                                     .arg(daemon->name())
                                     .arg(daemon->topics().size())
                                     .arg(mostTopics));
        }
    isListing_ = false;
}

// The numbers of a topic are those of its next message.
void PlotsPanel::listFields(DaemonLink *daemon, const QString &topic) {
    if (!daemon)
        return;
    message_->tell(tr("Waiting for a message of %1 ...").arg(shortLine(topic)));
    const auto handle = std::make_shared<int>(0);
    *handle = daemon->subscribe(
        topic, {}, [this, daemon = QPointer<DaemonLink>(daemon), topic, handle](const TopicUpdate &update) {
            if (!daemon)
                return;
            daemon->unsubscribe(*handle);
            isListing_ = true;
            const QStringList paths = numericPaths(update.json(), mostFields);
            for (QTreeWidgetItemIterator i(tree_); *i; ++i) {
                QTreeWidgetItem *const item = *i;
                if (item->data(0, TopicRole) != topic || item->data(0, PathRole).isValid() ||
                    daemonOf(*item) != daemon || item->childCount() > 0)
                    continue;
                for (const QString &path : paths) {
                    auto *const child =
                        new QTreeWidgetItem(item, {shortLine(path.isEmpty() ? topic : path, longestName)});
                    child->setData(0, AddressRole, daemon->address());
                    child->setData(0, TopicRole, topic);
                    child->setData(0, PathRole, path);
                    child->setData(0, DaemonRole, item->data(0, DaemonRole));
                    child->setCheckState(0, Qt::Unchecked);
                }
            }
            isListing_ = false;
            tickWanted();
            message_->tell(paths.isEmpty() ? tr("%1 has no number to plot.").arg(shortLine(topic))
                                           : tr("Tick a number to plot it."));
        });
}

void PlotsPanel::tickWanted() {
    for (QTreeWidgetItemIterator i(tree_); *i; ++i)
        if ((*i)->data(0, PathRole).isValid() && wanted_.erase(fieldOf(**i)) > 0) {
            (*i)->parent()->parent()->setExpanded(true);
            (*i)->parent()->setExpanded(true);
            (*i)->setCheckState(0, Qt::Checked);
        }
}

void PlotsPanel::onItemChanged(QTreeWidgetItem *item) {
    if (isListing_ || !item->data(0, PathRole).isValid())
        return;
    const FieldId field = fieldOf(*item);
    DaemonLink *const daemon = daemonOf(*item);
    if (item->checkState(0) == Qt::Checked && daemon) {
        auto *const series = new QLineSeries;
        series->setName(shortLine(field.topic + " " + field.path, longestName).toHtmlEscaped());
        chart_->addSeries(series);
        series->attachAxis(time_);
        series->attachAxis(value_);
        curves_[field] = series;
        sampler_.add(daemon, field);
    } else if (const auto curve = curves_.find(field); curve != curves_.end()) {
        chart_->removeSeries(curve->second);
        delete curve->second;
        curves_.erase(curve);
        sampler_.remove(field);
    }
}

void PlotsPanel::redraw() {
    if (pause_->isChecked() || curves_.empty() || !isVisible())
        return;
    double now = 0;
    for (const auto &[field, series] : curves_)
        if (!sampler_.samples(field).empty())
            now = std::max(now, sampler_.samples(field).back().x());
    double least = 1e300, most = -1e300;
    for (const auto &[field, series] : curves_) {
        QVector<QPointF> points;
        for (const QPointF &sample : sampler_.samples(field)) {
            if (sample.x() < now - span_s)
                continue;
            points.append({sample.x() - now, sample.y()});
            least = std::min(least, sample.y());
            most = std::max(most, sample.y());
        }
        series->replace(points);
    }
    if (sampler_.unusable() > 0)
        message_->tell(tr("%1 values cannot be plotted: no numbers, or too large.").arg(sampler_.unusable()));
    if (least > most)
        return;
    const double margin = std::max(0.05 * (most - least), 1e-3 * std::max(1.0, std::abs(most)));
    value_->setRange(least - margin, most + margin);
    value_->setTickCount(3); // more have no room for their labels in a low panel
    value_->applyNiceNumbers();
}

void PlotsPanel::askFile() {
    auto *const dialog = new QFileDialog(this, tr("Write the curves"), "curves.csv", tr("Tables (*.csv)"));
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setAcceptMode(QFileDialog::AcceptSave);
    dialog->setOption(QFileDialog::DontUseNativeDialog); // whose keys this program does not see
    connect(dialog, &QFileDialog::fileSelected, this, [this](const QString &file) {
        const auto done = exportTo(file);
        message_->tell(done ? tr("Wrote %1").arg(file) : done.error().message, !done);
    });
    dialog->show(); // not modal: STOP stays in reach
}

Result<void> PlotsPanel::exportTo(const QString &file) const {
    QSaveFile out(file);
    if (!out.open(QIODevice::WriteOnly))
        return Error(ErrorCode::InputOutput, tr("%1: %2").arg(file, out.errorString()));
    QTextStream text(&out);
    text.setRealNumberPrecision(17);
    text << "stamp,daemon,topic,field,value\n";
    for (const auto &[field, samples] : sampler_.all())
        for (const QPointF &sample : samples)
            text << sample.x() << ',' << field.address << ',' << field.topic << ',' << field.path << ','
                 << sample.y() << '\n';
    text.flush();
    if (!out.commit())
        return Error(ErrorCode::InputOutput, tr("%1: %2").arg(file, out.errorString()));
    return {};
}

} // namespace hermes::desktop
