//! Fresnel's equations (Born and Wolf, Principles of Optics, 1.5.2).

/// Reflectances [-] of both polarisations where light meets a medium of `index` (over that of its own) at a cosine of incidence: across
/// the plane of incidence and in it; 1 for total reflection.
pub fn polarised(cosine: f64, index: f64) -> [f64; 2] {
    let inside2 = 1.0 - (1.0 - cosine * cosine) / (index * index);
    if inside2 <= 0.0 {
        return [1.0; 2];
    }
    let inside = inside2.sqrt();
    let across = (cosine - index * inside) / (cosine + index * inside);
    let within = (index * cosine - inside) / (index * cosine + inside);
    [across * across, within * within]
}

/// Reflectance [-] of unpolarised light.
pub fn reflectance(cosine: f64, index: f64) -> f64 {
    let [across, within] = polarised(cosine, index);
    0.5 * (across + within)
}
