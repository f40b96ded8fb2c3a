"""How results are shown: name, ours, theirs, ratio."""


def heading(title: str, unit: str, theirs: str) -> None:
    """Begin a table that `row` goes on with."""
    print(f"\n{title} [{unit}]; theirs: {theirs}")
    print(f"{'name':<32} {'ours':>10} {'theirs':>12} {'ratio':>8}")


def row(name: str, ours: float, theirs: float | None, *, higher_is_better: bool = False) -> None:
    """A row; a ratio above 1 says that ours is the better. Where there is nothing to compare with it stays open."""
    if theirs is None:
        other, ratio = "-", "-"
    else:
        other, ratio = short(theirs), f"{ours / theirs if higher_is_better else theirs / ours:.2f}"
    print(f"{name:<32} {short(ours):>10} {other:>12} {ratio:>8}", flush=True)


def short(value: float) -> str:
    """Four digits, or all before the point."""
    return f"{value:.0f}" if value >= 1000 else f"{value:.4g}"
