//! What can be told of a collocation matrix before any run: its spectrum, how fast each method will
//! be, whether the proofs of convergence apply, its condition, and the place that is to blame.

mod condition;
mod dominance;
mod forecast;
mod places;
mod positivity;

pub use condition::Condition;
pub use dominance::{Dominance, dominance, dominates};
pub use forecast::{Forecast, Start};
pub use places::{Place, Spacing};
pub use positivity::TotalPositivity;

use crate::Error;
use crate::collocation::{
    CollocationMatrix, DenseCollocation, Eigenvalue, EigenvalueBounds, all_eigenvalues,
    best_weight, gauss_seidel_rate, lemma2_weight, rate_with_weight, smallest_eigenvalue_of,
};
use crate::iteration::UpdateRule;
use crate::iteration::update::{Chebyshev, GaussSeidel, Jacobi, Pia, Sor, Weighted};
pub(crate) use forecast::rehearse;
use forecast::{Window, WindowForecast, forecast, largest_norm};

/// Points up to which the whole matrix is one window, and all its eigenvalues are found.
pub const WHOLE: usize = 160;
/// Points of a window of a longer curve.
const WINDOW: usize = 128;
/// Windows spread evenly over a longer curve.
const EVENLY: usize = 3;

/// What is known of a collocation matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// Points, which are rows.
    pub points: usize,
    /// Bounds of the smallest eigenvalue, of a matrix that is not totally positive of the smallest
    /// modulus of one.
    pub smallest: EigenvalueBounds,
    /// All eigenvalues, those of largest real part first, up to [`WHOLE`] points.
    pub eigenvalues: Option<Vec<Eigenvalue>>,
    /// Total positivity: with it all eigenvalues lie in (0, 1].
    pub total_positivity: TotalPositivity,
    /// Diagonal dominance.
    pub dominance: Dominance,
    /// `||I - A||` in the maximum norm.
    pub contraction: f64,
    /// Bounds of the largest singular value. Weights per point below its reciprocal converge by
    /// Chen, Wang and Jin (2012), Theorem 2; with total positivity all in (0, 2) do.
    pub largest_singular_value: (f64, f64),
    /// Condition in the maximum norm.
    pub condition: Condition,
    /// The weight of Chen, Wang and Jin (2012), Lemma 2; `None` where no weight converges, or it is
    /// not known.
    pub lemma2_weight: Option<f64>,
    /// The best single weight and the rate with it; `None` as above.
    pub best_weight: Option<(f64, f64)>,
    /// A forecast for each method that iterates: pia, weighted, jacobi, gauss-seidel, sor,
    /// chebyshev. The method auto is a banded solve and needs a step or two.
    pub forecasts: Vec<Forecast>,
    /// Where the slowest part of a residual sits; `None` without a spacing, as all places.
    pub slowest: Option<Place>,
    /// Where the inverse is largest.
    pub most_sensitive: Option<Place>,
    /// Where a basis function is smallest at its own parameter.
    pub weakest: Option<Place>,
}

/// Diagnoses a matrix. Its cost is linear in the points of a band; a spacing finds places to blame,
/// a start finds numbers of steps.
///
/// # Errors
/// [`Error::Singular`], [`Error::SingularBasis`].
pub fn diagnose(
    matrix: &dyn CollocationMatrix,
    spacing: Option<Spacing<'_>>,
    start: Option<Start<'_>>,
) -> Result<Diagnosis, Error> {
    let points = matrix.points();
    let closed = spacing.is_some_and(|spacing| spacing.period.is_some());
    let total_positivity = positivity::total_positivity(matrix);
    let factors = matrix.factor(None)?;
    let condition = condition::condition(matrix, &factors)?;
    drop(factors);
    let whole = if points <= WHOLE { all_eigenvalues(matrix)? } else { None };
    let for_weights = smallest_eigenvalue_of(matrix)?;
    let dominance = dominance(matrix);

    let windows = windows(matrix, closed, start, &[for_weights.place, condition.place])?;
    let of_windows = windows
        .iter()
        .filter_map(|window| all_eigenvalues(&window.matrix).ok()??.last().map(|least| least.re));
    let of_windows = of_windows.fold(f64::INFINITY, f64::min);
    let smallest = bounds(for_weights, whole.as_deref(), of_windows, total_positivity);
    let (lemma2, best) = weights(total_positivity, &dominance, &smallest, whole.as_deref());
    let forecasts = forecasts(matrix, &windows, for_weights, smallest.estimate, best);
    let weakest = (0..points)
        .map(|j| (j, matrix.diagonal(j)))
        .fold((0, f64::INFINITY), |least, now| if now.1 < least.1 { now } else { least })
        .0;
    let place = |point: usize| spacing.map(|spacing| spacing.around(point, matrix));
    Ok(Diagnosis {
        points,
        smallest,
        eigenvalues: whole,
        total_positivity,
        dominance,
        contraction: condition::contraction(matrix),
        largest_singular_value: condition::largest_singular_value(matrix),
        condition,
        lemma2_weight: lemma2,
        best_weight: best,
        forecasts,
        slowest: place(smallest.place),
        most_sensitive: place(condition.place),
        weakest: place(weakest),
    })
}

/// Bounds that hold: without total positivity, those of inverse iteration are none. With it, the
/// eigenvalues of a window, which is a principal submatrix, are not below the smallest of the whole.
fn bounds(
    found: EigenvalueBounds,
    whole: Option<&[Eigenvalue]>,
    of_windows: f64,
    total_positivity: TotalPositivity,
) -> EigenvalueBounds {
    let least = |all: &[Eigenvalue]| {
        all.iter().fold(f64::INFINITY, |least, value| least.min(value.modulus()))
    };
    match whole {
        _ if total_positivity == TotalPositivity::Known => {
            // Next to rounding, inverse iteration keeps the digits that QR steps lose.
            let upper =
                if of_windows > found.lower { found.upper.min(of_windows) } else { found.upper };
            let estimate = match whole {
                Some(all) if (found.lower..=found.upper).contains(&least(all)) => least(all),
                _ => found.estimate.clamp(found.lower, upper),
            };
            EigenvalueBounds { estimate, upper, ..found }
        }
        Some(all) => {
            let least = least(all);
            EigenvalueBounds { lower: least, estimate: least, upper: least, ..found }
        }
        None => EigenvalueBounds { lower: 0.0, upper: 1.0, ..found },
    }
}

type Weights = (Option<f64>, Option<(f64, f64)>);

fn weights(
    total_positivity: TotalPositivity,
    dominance: &Dominance,
    smallest: &EigenvalueBounds,
    whole: Option<&[Eigenvalue]>,
) -> Weights {
    if total_positivity.holds() {
        let least = smallest.estimate;
        let omega = Weighted::best_for(least);
        return (Some(1.0), Some((omega, omega - 1.0)));
    }
    match whole {
        Some(all) => (lemma2_weight(all), best_weight(all)),
        // The discs of Gershgorin, scaled by the certificate, lie within distance 1 from 1.
        None => (dominance.is_generalised().then_some(1.0), None),
    }
}

/// The whole matrix of few points; otherwise windows around the places named, that of the largest
/// residual, and some more.
fn windows(
    matrix: &dyn CollocationMatrix,
    closed: bool,
    start: Option<Start<'_>>,
    places: &[usize],
) -> Result<Vec<Window>, Error> {
    let points = matrix.points();
    let window = |first: usize, count: usize| -> Result<Window, Error> {
        let matrix = DenseCollocation::window(matrix, first, count)?;
        Ok(match start {
            None => Window { matrix, vectors: Vec::new(), dimension: 1, tolerance: 0.0 },
            Some(Start { difference_vectors, dimension, tolerance }) => {
                let vectors = (first..first + count)
                    .flat_map(|j| &difference_vectors[j % points * dimension..][..dimension])
                    .copied()
                    .collect();
                Window { matrix, vectors, dimension, tolerance }
            }
        })
    };
    if points <= WHOLE {
        return Ok(vec![window(0, points)?]);
    }
    let mut centres = places.to_vec();
    centres.extend((0..EVENLY).map(|k| k * (points - 1) / (EVENLY - 1)));
    if let Some(start) = start {
        let worst = start
            .difference_vectors
            .chunks_exact(start.dimension)
            .map(|vector| vector.iter().map(|x| x * x).sum::<f64>())
            .enumerate()
            .fold((0, 0.0), |best, now| if now.1 > best.1 { now } else { best });
        centres.push(worst.0);
    }
    let first = |centre: usize| {
        if closed {
            (centre + points - WINDOW / 2) % points
        } else {
            centre.saturating_sub(WINDOW / 2).min(points - WINDOW)
        }
    };
    let mut firsts: Vec<usize> = centres.into_iter().map(first).collect();
    firsts.sort_unstable();
    // A window that lies mostly in another has nothing to add.
    firsts.dedup_by(|next, kept| *next - *kept < WINDOW / 4);
    firsts.into_iter().map(|first| window(first, WINDOW)).collect()
}

fn forecasts(
    matrix: &dyn CollocationMatrix,
    windows: &[Window],
    for_weights: EigenvalueBounds,
    smallest: f64,
    best: Option<(f64, f64)>,
) -> Vec<Forecast> {
    let least = for_weights.for_weights();
    let weighted = match best {
        Some((omega, _)) if !matrix.is_totally_positive() => omega,
        _ => Weighted::best_for(least),
    };
    let relaxed = Sor::best_for(gauss_seidel_rate(matrix));
    type Rule = for<'a> fn(&'a DenseCollocation, f64) -> Box<dyn UpdateRule + 'a>;
    let rules: [(&'static str, Option<f64>, Rule); 5] = [
        ("pia", None, |_, _| Box::new(Pia)),
        ("weighted", Some(weighted), |_, omega| Box::new(Weighted::new(omega))),
        ("jacobi", None, |matrix, _| Box::new(Jacobi::new(matrix))),
        ("gauss-seidel", None, |matrix, _| Box::new(GaussSeidel::new(matrix))),
        ("sor", Some(relaxed), |matrix, omega| Box::new(Sor::new(matrix, omega))),
    ];
    let mut list = Vec::with_capacity(rules.len() + 1);
    for (method, weight, make) in rules {
        let found = windows
            .iter()
            .map(|window| forecast(window, make(&window.matrix, weight.unwrap_or(1.0)).as_mut()));
        let mut joined = joined(method, weight, found);
        if matrix.is_totally_positive() && weight.is_none_or(|_| method == "weighted") {
            sharpen(&mut joined, smallest);
        }
        list.push(joined);
    }
    list.push(chebyshev(windows, least, smallest));
    list
}

/// The slowest window decides.
fn joined(
    method: &'static str,
    weight: Option<f64>,
    windows: impl Iterator<Item = WindowForecast>,
) -> Forecast {
    let mut all = Forecast {
        method,
        weight,
        rate: 0.0,
        growth: 1.0,
        iterations: Some(0),
        stalls: false,
        spectrum: (f64::INFINITY, f64::NEG_INFINITY),
    };
    for one in windows {
        all.rate = if one.rate > all.rate || one.rate.is_nan() { one.rate } else { all.rate };
        all.growth = if one.growth > all.growth { one.growth } else { all.growth };
        all.stalls |= one.stalls;
        all.iterations = all.iterations.zip(one.iterations).map(|(a, b)| a.max(b));
        all.spectrum = (all.spectrum.0.min(one.spectrum.0), all.spectrum.1.max(one.spectrum.1));
    }
    all
}

/// Rates that the smallest eigenvalue gives directly hold to more digits than those of error
/// matrices, which lose it next to 1.
fn sharpen(forecast: &mut Forecast, smallest: f64) {
    let omega = match forecast.method {
        "pia" => 1.0,
        "weighted" => forecast.weight.unwrap_or(1.0),
        _ => return,
    };
    let real = |re: f64| Eigenvalue { re, im: 0.0 };
    forecast.rate = rate_with_weight(&[real(smallest), real(1.0)], omega);
    forecast.spectrum = (omega * smallest, omega);
}

/// Steps of Chebyshev that are rehearsed on a window; beyond, the rate tells.
const MOST_REHEARSED: usize = 4000;

fn chebyshev(windows: &[Window], least: f64, smallest: f64) -> Forecast {
    let root = least.sqrt();
    let rate = (1.0 - root) / (1.0 + root);
    let (mut iterations, mut stalls) = (Some(0), false);
    for window in windows {
        let mut rule = Chebyshev::new(least, 1.0, window.vectors.len());
        let (found, stalled) = if window.vectors.is_empty() || rate >= 1.0 {
            (None, false)
        } else {
            let start = Start {
                difference_vectors: &window.vectors,
                dimension: window.dimension,
                tolerance: window.tolerance,
            };
            let seen = rehearse(&window.matrix, start, &mut rule, MOST_REHEARSED);
            if seen.end.is_some() || seen.stalls {
                (seen.end, seen.stalls)
            } else {
                let first = largest_norm(&window.vectors, window.dimension);
                (steps_at_rate(2.0 * first, window.tolerance, rate), false)
            }
        };
        stalls |= stalled;
        iterations = iterations.zip(found).map(|(a, b): (u64, u64)| a.max(b));
    }
    let (spectrum, weight) = ((smallest, 1.0), Some(least));
    Forecast { method: "chebyshev", weight, rate, growth: 1.0, iterations, stalls, spectrum }
}

/// Points in each direction up to which the weights of a product are worth all its eigenvalues.
const FEW_LINES: usize = 64;

/// The weight of Lemma 2 for a Kronecker product, and, where a direction is not totally positive and
/// eigenvalues are few, the best single weight with its rate; `None` where it is not known, or no
/// weight converges.
#[must_use]
pub fn product_weights(directions: [&Diagnosis; 2]) -> (Option<f64>, Option<(f64, f64)>) {
    let [u, v] = directions;
    if u.total_positivity.holds() && v.total_positivity.holds() {
        return (Some(1.0), None);
    }
    let Some((of_u, of_v)) = u.eigenvalues.as_ref().zip(v.eigenvalues.as_ref()) else {
        return (None, None);
    };
    let all: Vec<Eigenvalue> =
        of_u.iter().flat_map(|a| of_v.iter().map(move |b| a.times(*b))).collect();
    let few = u.points.max(v.points) <= FEW_LINES;
    (lemma2_weight(&all), if few { best_weight(&all) } else { None })
}

/// Forecasts for a Kronecker product, whose eigenvalues are products, with rules that act in both
/// directions in every step. Steps are not told.
#[must_use]
pub fn at_once(directions: [&Diagnosis; 2]) -> Vec<Forecast> {
    let product = |method: &str| {
        let [(u_low, u_high), (v_low, v_high)] = directions.map(|direction| {
            direction
                .forecasts
                .iter()
                .find(|forecast| forecast.method == method)
                .map_or((f64::NAN, f64::NAN), |forecast| forecast.spectrum)
        });
        (u_low * v_low, u_high * v_high)
    };
    let of = |method, weight, spectrum: (f64, f64), rate| Forecast {
        method,
        weight,
        rate,
        growth: 1.0,
        iterations: None,
        stalls: false,
        spectrum,
    };
    let spread = |(low, high): (f64, f64)| (1.0 - low).abs().max((1.0 - high).abs());
    let least = directions[0].smallest.for_weights() * directions[1].smallest.for_weights();
    let best = product_weights(directions).1;
    let omega = best.map_or_else(|| Weighted::best_for(least), |(omega, _)| omega);
    let (low, high) = product("pia");
    let root = least.sqrt();
    vec![
        of("pia", None, (low, high), spread((low, high))),
        of(
            "weighted",
            Some(omega),
            (omega * low, omega * high),
            spread((omega * low, omega * high)),
        ),
        of("jacobi", None, product("jacobi"), spread(product("jacobi"))),
        of("gauss-seidel", None, product("gauss-seidel"), spread(product("gauss-seidel"))),
        of("chebyshev", Some(least), (low, high), (1.0 - root) / (1.0 + root)),
    ]
}

/// Steps in which a residual falls from one size to another at a steady rate.
#[must_use]
pub fn steps_at_rate(from: f64, to: f64, rate: f64) -> Option<u64> {
    if from <= to {
        return Some(0);
    }
    if rate <= 0.0 {
        return Some(1);
    }
    let steps = (to / from).ln() / rate.ln();
    (steps.is_finite() && (0.0..1e15).contains(&steps)).then(|| steps.ceil() as u64)
}
