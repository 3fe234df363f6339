#pragma once

#include "gui/desktop/panels/PlotBoard.h"
#include "gui/desktop/widgets/SaveDialog.h"
#include "gui/desktop/widgets/WrittenFile.h"

#include <QTimer>

class QMenu;
class QPushButton;
class QStackedWidget;
class QToolButton;

namespace hermes::desktop {

class MessageLabel;
class MessageView;
class PlotSets;
class PlotSuggestions;
class TopicTree;

/// Curves of any numeric field of any topic over time, chosen by a tick, in several charts; sets of them by
/// name; files of them; and the newest message of any topic.
class PlotsPanel : public QWidget {
    Q_OBJECT
public:
    explicit PlotsPanel(Fleet &fleet, QWidget *parent = nullptr);

    PlotBoard &board() { return *board_; }
    /// What is plotted, for setState() of the next start: as soon as its daemons are there.
    QJsonObject state() const { return board_->state(); }
    void setState(const QJsonObject &state) { board_->setState(state); }
    /// The sets that are kept by name.
    PlotSets &sets() { return *sets_; }
    /// Writes all that is kept as CSV, or what is shown as SVG or PNG, as the name ends. Error: the file
    /// cannot be written.
    Result<void> exportTo(const QString &file) const { return drawn(file)(); }

private:
    void layOut();
    QLayout *makeButtons();
    QMenu *makeSpans();
    QMenu *makePanes();
    QMenu *makeExports();
    void tick(const FieldId &field, bool isOn);
    void plot(const std::vector<FieldId> &fields);
    void onBoardChanged();
    void showTime();
    void showPage();
    void redraw();
    void askFile(const QString &title, const QString &name, const QString &kinds);
    void write(const QString &file);
    Writing drawn(const QString &file) const;

    PlotBoard *board_;
    TopicTree *tree_;
    MessageLabel *message_;
    MessageView *newest_;
    PlotSuggestions *suggestions_;
    PlotSets *sets_;
    QStackedWidget *pages_;
    QPushButton *pause_, *showMessage_;
    QToolButton *span_;
    QTimer timer_;
    OneDialog export_;
};

} // namespace hermes::desktop
