"""The expression language against `rcalc`, in one run."""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy import special

import sunpeak as sp
from conftest import Radiance

# Functions of the library with arguments in their domains, in terms of x = $1, y = $2 (in 0 to 1), z = $3 (-5 to 5).
FUNCTIONS = """
sin(z) cos(z) tan(z) asin(x) acos(x) atan(z) atan2(z,y) exp(z) log(x) log10(y) sqrt(x) floor(z) ceil(z) rand(z)
rand(x) rand(1e4*y) if(z,x,y) if(-z,x,y) if(x-y,sin(x),cos(y)) select(1+2*x,x,y,z) select(3,x,y,z) select(0,x,y,z)
min(x,y,z) max(x,y,z) min(z) max(z,x) bound(-1,z,1) bound(x,y,z) Acos(z) Asin(z) Atan2(z,x) Atan2(0,0) Exp(z)
Exp(-500) Sqrt(z) Sqrt(x) and(z,x) and(x,z) or(z,x) or(-x,y) not(z) not(x) xor(z,x-.5) xor(z,y-.5) abs(z) sgn(z)
sgn(0) sq(z) inside(.2,x,.7) frac(z) mod(z,1.3) mod(10*z,x) tri(z,1.5) tri(x,.3) linterp(x,y,z) noop(z) clip(z)
noneg(z) red(x,y,z) green(x,y,z) blue(x,y,z) grey(x,y,z) clip_r(z,y,x) clip_g(y,z,x) clip_b(x,y,z) clipgrey(x,y,z)
clipgrey(2,2,z) fade(x,y,3*abs(z)) fade(x,y,20) hermite(1,z,x,y,.3) hermite(x,y,z,2,y) bezier(x,y,z,1,.7)
bezier(z,1,x,y,x) bspline(x,y,z,1,.7) bspline(z,1,x,y,x) unif2norm(x) unif2norm(y) nrand(z) nrand(x) dot(vec,vec)
dot(vec,wec) cross(1,vec,wec) cross(2,vec,wec) cross(3,vec,wec) PI*x DEGREE*z FTINY+z
"""

# The grammar: signs, powers, order, names, functions as arguments, recursion, variables of variables, channels.
FORMULAS = """
-x^2 -(x)^2 2^-z x^y^2 (x^y)^2 1-2-x 8/4/2/x x*y/z x/(y*z) +x--1 -(-z) x+y*z^2 (x+y)*z 1e-3*x .5*y 5.*z 1.5E2+x 3e+0-x
2*-3*x x*-y twice(sq,z) twice(sin,x) apply2(min,x,z) apply2(max,y,z) fac(6) fac(3+z-z) sum(20) poly(x) poly(poly(y))
both(x,y) va vb+va vc*vb if(vc,va,vb) v.with_dots v.with_dots+v1 if(if(z,-1,1),if(x-.5,1,2),if(y-.5,3,4)) $1+$2*$3 -$3
((((x)))) (x)(y)*0+x gcd(1071,462) horner(x,y) lazy(x,1/(x-x)) select(2,1/(x-x),y,1/(y-y)) 0*z x^0 1^z x^1 z/4 0/y
arr(1)+arr(2) arr(3)*x fold(add2,4) cubic(z,x,y) sin(cos(tan(x))) sq(sq(sq(y))) max(min(x,y),min(y,z),min(z,x))
10*x-floor(10*x) x>y
"""

DEFINITIONS = """
{ Comments { nest } and may stand anywhere: } x { here } = $1; y = $2;z=$3;
twice(f, a) = f(f(a)); apply2(f, a, b) = f(a, b) - 1;
fac(n) : if(n - 1.5, n * fac(n - 1), 1); sum(n) = if(n - .5, n + sum(n - 1), 0);
poly(t) = 1 + t * (2 + t * (3 + t)); both(a, b) = a * poly(b) + b * poly(a);
va = x + 1; vb = va * va - y; vc = vb / va + va; v.with_dots = vc + .25; v1 : 3 * 4; v_2 : v1 + 1;
gcd(a, b) = if(b - .5, gcd(b, mod(a, b)), a); horner(a, b) = ((a + b) * a + b) * a + b; lazy(a, b) = a;
arr(i) : select(i, 3, 1, 4, 1, 5); add2(a, b) = a + b; fold(f, n) = if(n - 1.5, f(arr(n), fold(f, n - 1)), arr(1));
cubic(t, a, b) = hermite(a, b, v1, v_2, frac(t));
vec(i) = select(i, x, y, z); wec(i) = select(i, z, x * y, 1);
"""

# As many again by combining.
COMBINED = [
    f"({a}) * .5 + sq({b})"
    for a, b in zip(["x", "y", "z", "x*y", "y*z", "z*x", "va", "vb", "vc", "v1"], "xyzxyzxyzx", strict=True)
] + [
    f"{f}({a})"
    for f in ["sin", "cos", "abs", "frac", "sgn", "clip"]
    for a in ["x+y", "y*z", "-z", "va", "vb/2", "x-y-z", "z^3", "2*x"]
]

# `rcalc` has no operator `>`, and calls nothing but names.
NO_LANGUAGE = {"x>y", "(x)(y)*0+x"}


def expressions() -> list[str]:
    """Each once."""
    words = [*FUNCTIONS.split(), *FORMULAS.split(), *COMBINED]
    return [word for word in dict.fromkeys(words) if word not in NO_LANGUAGE]


def rows() -> np.ndarray:
    """Channels at which nothing is out of its domain, and no two numbers are alike."""
    random = np.random.default_rng(20)
    return np.round(np.column_stack([random.random((24, 2)) * 0.98 + 0.01, random.random(24) * 10 - 5]), 7)


def test_expressions_and_library(radiance: Radiance) -> None:
    """200 expressions, and every function that `rcalc` has with Radiance's own definitions, to 1e-12."""
    texts, channels = expressions(), rows()
    assert len(texts) >= 200
    program = DEFINITIONS + "".join(f"${i + 1}={text};\n" for i, text in enumerate(texts))
    data = "\n".join(" ".join(f"{number:.7f}" for number in row) for row in channels) + "\n"
    answer = radiance.run("rcalc", "-od", "-f", radiance.library / "rayinit.cal", "-e", program, data=data)
    theirs = np.frombuffer(answer, dtype=np.float64).reshape(len(channels), len(texts))
    ours = sp.evaluate(texts, channels, definitions=DEFINITIONS)
    assert np.isfinite(ours).all(), [texts[i] for i in np.argwhere(~np.isfinite(ours))[:, 1]]
    off = np.abs(ours - theirs) / np.maximum(np.abs(theirs), 1)
    worst = {texts[i]: float(off[:, i].max()) for i in range(len(texts)) if off[:, i].max() > 1e-12}
    assert not worst, worst


# Functions that Radiance's renderers have and `rcalc` has not, of x and y.
OF_RENDERERS = """
erf(x) erfc(x) noise3(5*x,7*y,3) noise3x(5*x,7*y,3) noise3y(5*x,7*y,3) noise3z(5*x,7*y,3) noise3a(5*x,7*y,3)
noise3b(5*x,7*y,3) noise3c(5*x,7*y,3) noise3d(2,5*x,7*y,3) fnoise3(5*x,7*y,3) turbulence(5*x,7*y,3,.01)
turbulencex(5*x,7*y,3,.01) turbulencey(5*x,7*y,3,.01) turbulencez(5*x,7*y,3,.01)
"""


def test_functions_of_the_renderers(radiance: Radiance, tmp_path: Path) -> None:
    """As patterns of what shines, so that `rtrace` prints them; its colours are single floats."""
    functions = OF_RENDERERS.split()
    scene = "".join(
        f"void brightfunc p{i} 2 {text}+5 f.cal 0 0\np{i} glow g{i} 0 0 4 1 1 1 0\n"
        f"g{i} polygon s{i} 0 0 12 0 0 {-i} 1 0 {-i} 1 1 {-i} 0 1 {-i}\n"
        for i, text in enumerate(functions)
    )
    (tmp_path / "f.cal").write_text("x = Px; y = Py;\n")
    places = np.random.default_rng(4).random((12, 2))
    octree = radiance.octree(tmp_path / "s.oct", text=scene, folder=tmp_path)
    rays = [[x, y, 0.5 - i, 0, 0, -1] for i in range(len(functions)) for x, y in places]
    theirs = radiance.rtrace(octree, rays, folder=tmp_path)[:, 0].reshape(-1, len(places)).T
    texts = [re.sub(r"\bx\b", "$1", re.sub(r"\by\b", "$2", text)) for text in functions]
    assert sp.evaluate(texts, places) + 5 == pytest.approx(theirs, rel=2e-6)


def test_bessel_functions() -> None:
    """Radiance's programs have them only where they were built so: by SciPy."""
    x = np.linspace(0.05, 30, 50)
    texts = [*(f"{name}($1)" for name in ("j0", "j1", "y0", "y1")), "jn(3,$1)", "yn(4,$1)"]
    known = [special.j0(x), special.j1(x), special.y0(x), special.y1(x), special.jn(3, x), special.yn(4, x)]
    assert sp.evaluate(texts, x[:, None]) == pytest.approx(np.transpose(known), rel=1e-12, abs=1e-12)


def test_every_function_of_rayinit_is_ours(radiance: Radiance) -> None:
    """What Radiance's initialisation file defines, and says that it has, we have without it."""
    text = (radiance.library / "rayinit.cal").read_text()
    code = re.sub(r"{[^{}]*}", "", text)
    code = re.sub(r"{[^{}]*}", "", code)
    names = re.findall(r"^([A-Za-z]\w*)\(", code, re.MULTILINE)
    of_rays = {"D", "N", "P", "Ldx", "Ldy", "Ldz"}
    assert len(names) > 40
    for name in set(names) - of_rays:
        with pytest.raises(sp.InputError, match="expected"):
            sp.evaluate([f"{name}()"], np.zeros((1, 1)))
        count = code[code.index(f"\n{name}(") :].split(")")[0].count(",") + 1
        given = ",".join(["noop"] * count if name in {"dot", "cross"} else [".5"] * count)
        given = f"1,{given[2:]}" if name == "cross" else given
        assert np.isfinite(sp.evaluate([f"{name}({given.replace('1,op', '1,noop')})"], np.zeros((1, 1)))).all(), name
