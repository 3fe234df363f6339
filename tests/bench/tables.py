"""What the tables of several benchmarks are made with."""
import math


def slope(points):
    """Of log y over log x of the points (x, y), by least squares: 1 where y grows with x, 2 where it grows with its square."""
    x, y = [math.log(p) for p, _ in points], [math.log(q) for _, q in points]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((p - mx) * (q - my) for p, q in zip(x, y)) / sum((p - mx) ** 2 for p in x)


def verdict(is_good):
    return "reached" if is_good else "missed"
