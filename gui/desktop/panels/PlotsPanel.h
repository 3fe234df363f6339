#pragma once

#include "gui/desktop/model/TopicSampler.h"

#include <QTimer>
#include <QWidget>
#include <QtCharts/QChartGlobal>

QT_CHARTS_BEGIN_NAMESPACE
class QChart;
class QChartView;
class QLineSeries;
class QValueAxis;
QT_CHARTS_END_NAMESPACE
class QPushButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace hermes::desktop {

class MessageLabel;

/// Curves of any numeric field of any topic over time, chosen by a click; with pause and CSV.
class PlotsPanel : public QWidget {
    Q_OBJECT
public:
    static constexpr double span_s = 30;

    explicit PlotsPanel(Fleet &fleet, QWidget *parent = nullptr);

    /// What is plotted, for plot() of the next start.
    QStringList plotted() const;
    /// Plots these as soon as their daemons are there.
    void plot(const QStringList &fields);
    /// Writes all curves: stamp, daemon, topic, field, value. Error: the file cannot be written.
    Result<void> exportTo(const QString &file) const;

private:
    void listTopics();
    void listFields(DaemonLink *daemon, const QString &topic);
    void tickWanted();
    void onItemChanged(QTreeWidgetItem *item);
    void redraw();
    void askFile();
    QWidget *makeButtons();

    Fleet &fleet_;
    TopicSampler sampler_;
    QTreeWidget *tree_;
    QtCharts::QChart *chart_;
    QtCharts::QChartView *chartView_;
    QtCharts::QValueAxis *time_, *value_;
    MessageLabel *message_;
    QPushButton *pause_;
    QTimer timer_;
    std::map<FieldId, QtCharts::QLineSeries *> curves_;
    std::set<FieldId> wanted_; ///< not there as yet
    bool isListing_ = false;
};

} // namespace hermes::desktop
