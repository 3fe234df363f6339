#pragma once

#include "gui/desktop/model/CurveTable.h"
#include "gui/desktop/view/TimeWindow.h"

#include <QPen>
#include <QWidget>

class QBoxLayout;

namespace hermes::desktop {

class PlotPane;

/// The charts of the plots, one below the other, over one time. New curves go to the chosen one.
class PlotBoard : public QWidget {
    Q_OBJECT
public:
    static constexpr int maxPanes = 8, maxCurves = 32;

    explicit PlotBoard(Fleet &fleet, QWidget *parent = nullptr);

    TimeWindow &time() { return time_; }
    const TopicSampler &sampler() const { return sampler_; }
    std::vector<PlotPane *> panes() const;
    bool has(const FieldId &field) const { return sampler_.all().count(field) > 0; }
    int curves() const { return int(sampler_.all().size()); }

    /// Into the chosen pane. False: there are too many.
    bool add(const FieldId &field);
    void remove(const FieldId &field);
    /// Gives a curve the value axis on the right, or that on the left.
    void setRight(const FieldId &field, bool isRight);
    void addPane();
    /// With its curves; the last one is only emptied.
    void removePane();
    bool canAddPane() const { return panes_.size() < std::size_t(maxPanes); }
    int chosenPane() const { return int(chosen_); }
    void choosePane(int pane);

    /// Live again, with automatic axes.
    void goLive();
    /// Shows what has come since the last time.
    void redraw();
    /// What is plotted where, and over which time; for setState().
    QJsonObject state() const;
    void setState(const QJsonObject &state);

    void render(QPainter &painter) const;
    /// All that is kept, for writeCurves().
    std::vector<KeptCurve> kept() const;

Q_SIGNALS:
    /// Curves or panes came or went.
    void changed();

private:
    struct Curve {
        FieldId field;
        QPen pen;
        std::optional<QString> unit; ///< nothing: its daemon has not told as yet
        std::optional<bool> isRight; ///< nothing: when its unit is another than that of the first curve
    };
    struct Pane {
        PlotPane *widget;
        std::vector<Curve> curves;
    };

    void clear();
    void openMenu(const PlotPane &pane, const QPoint &place);
    Pane &newPane();
    void insert(Pane &pane, const FieldId &field, std::optional<bool> isRight);
    int freePen() const;
    void showCurves();
    void fillScene(Pane &pane);
    double nowOf(const FieldId &field);
    void findUnit(Curve &curve) const;
    QString nameOf(const FieldId &field) const;
    QString ownerOf(const FieldId &field) const;
    QString cursorTime() const;

    Fleet &fleet_;
    TopicSampler sampler_;
    TimeWindow time_;
    QBoxLayout *layout_;
    std::vector<Pane> panes_;
    std::size_t chosen_ = 0;
    std::map<QString, double> heldNow_; ///< by clock, while the picture stands
};

} // namespace hermes::desktop
