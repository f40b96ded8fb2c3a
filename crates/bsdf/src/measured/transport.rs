//! The cheapest way to move one distribution of masses into another (earth mover): exact, by shortest augmenting paths.
//!
//! Rows are what is moved, columns where to. Prices of rows and columns keep every reduced cost at zero or above and at zero where
//! mass flows, so that each shortest path keeps the plan the cheapest one for what has been moved so far (Ahuja, Magnanti and Orlin,
//! "Network Flows", 1993, section 9.7).

/// Mass that moves from a row to a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// Row.
    pub from: usize,
    /// Column.
    pub to: usize,
    /// Share of all mass [-].
    pub mass: f64,
}

/// Masses below this share of the whole count as nothing.
const NOTHING: f64 = 1e-12;

/// The cheapest plan between masses that are normalised to one; `cost` [any unit] of a unit of mass, none negative.
pub fn plan(from: &[f64], to: &[f64], cost: impl Fn(usize, usize) -> f64) -> Vec<Move> {
    let share = |masses: &[f64]| -> Vec<f64> {
        let sum: f64 = masses.iter().sum();
        masses.iter().map(|m| m / sum).collect()
    };
    let costs = (0..from.len()).flat_map(|i| (0..to.len()).map(move |j| (i, j))).map(|(i, j)| cost(i, j));
    let mut network = Network {
        width: to.len(),
        costs: costs.collect(),
        supply: share(from),
        demand: share(to),
        flows: vec![Vec::new(); to.len()],
        row_price: vec![0.0; from.len()],
        column_price: vec![0.0; to.len()],
    };
    for row in 0..from.len() {
        while network.supply[row] > NOTHING && network.augment(row) {}
    }
    let moves = network.flows.iter().enumerate();
    let moves = moves.flat_map(|(to, rows)| rows.iter().map(move |&(from, mass)| Move { from, to, mass }));
    moves.filter(|m| m.mass > NOTHING).collect()
}

struct Network {
    width: usize,
    costs: Vec<f64>,
    supply: Vec<f64>,
    demand: Vec<f64>,
    /// By column: rows and what they send there.
    flows: Vec<Vec<(usize, f64)>>,
    row_price: Vec<f64>,
    column_price: Vec<f64>,
}

/// Shortest paths from one row, as far as they were followed.
struct Search {
    /// By row: distance, and the column that it was reached by; none: not reached.
    rows: Vec<Option<(f64, Option<usize>)>>,
    /// By column: distance, and the row that it was reached by.
    columns: Vec<(f64, usize)>,
    done: Vec<bool>,
}

impl Network {
    /// Send mass from a row along the shortest path to a column that still takes some; false if there is none.
    fn augment(&mut self, source: usize) -> bool {
        let mut search = Search {
            rows: vec![None; self.supply.len()],
            columns: vec![(f64::INFINITY, source); self.width],
            done: vec![false; self.width],
        };
        search.rows[source] = Some((0.0, None));
        self.relax(&mut search, source, 0.0);
        loop {
            let open = (0..self.width).filter(|&j| !search.done[j]);
            let Some(column) = open.min_by(|&a, &b| search.columns[a].0.total_cmp(&search.columns[b].0))
            else {
                return false;
            };
            let distance = search.columns[column].0;
            search.done[column] = true;
            if self.demand[column] > NOTHING {
                self.send(&search, source, column);
                self.reprice(&search, distance);
                return true;
            }
            for k in 0..self.flows[column].len() {
                let (row, _) = self.flows[column][k];
                if search.rows[row].is_none() {
                    search.rows[row] = Some((distance, Some(column)));
                    self.relax(&mut search, row, distance);
                }
            }
        }
    }

    fn relax(&self, search: &mut Search, row: usize, distance: f64) {
        let costs = &self.costs[row * self.width..(row + 1) * self.width];
        for (j, cost) in costs.iter().enumerate() {
            let through = distance + cost - self.row_price[row] - self.column_price[j];
            if !search.done[j] && through < search.columns[j].0 {
                search.columns[j] = (through, row);
            }
        }
    }

    fn send(&mut self, search: &Search, source: usize, target: usize) {
        // Pairs of columns along the path: mass goes into the first, and leaves the second for it.
        let mut path = Vec::new();
        let mut column = target;
        loop {
            let row = search.columns[column].1;
            let before = search.rows[row].and_then(|(_, before)| before);
            path.push((row, column, before));
            match before {
                Some(before) => column = before,
                None => break,
            }
        }
        let mut mass = self.supply[source].min(self.demand[target]);
        for &(row, _, before) in &path {
            if let Some(before) = before {
                mass = mass.min(self.flows[before].iter().find(|f| f.0 == row).map_or(0.0, |f| f.1));
            }
        }
        self.supply[source] -= mass;
        self.demand[target] -= mass;
        for (row, column, before) in path {
            match self.flows[column].iter_mut().find(|f| f.0 == row) {
                Some(flow) => flow.1 += mass,
                None => self.flows[column].push((row, mass)),
            }
            if let Some(before) = before {
                self.flows[before].iter_mut().filter(|f| f.0 == row).for_each(|f| f.1 -= mass);
                self.flows[before].retain(|f| f.1 > NOTHING * 1e-3);
            }
        }
    }

    fn reprice(&mut self, search: &Search, farthest: f64) {
        for (price, reached) in self.row_price.iter_mut().zip(&search.rows) {
            *price += reached.map_or(0.0, |(distance, _)| farthest - distance);
        }
        for (price, (&(distance, _), done)) in
            self.column_price.iter_mut().zip(search.columns.iter().zip(&search.done))
        {
            *price -= if *done { farthest - distance } else { 0.0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_a_line_the_cheapest_plan_keeps_the_order() {
        // Closed form: with a convex cost on a line, quantiles go to quantiles.
        let (x, y) = ([0.9_f64, 0.1, 0.5, 0.3], [0.2_f64, 1.4, 0.8]);
        let (from, to) = ([1.0, 2.0, 3.0, 2.0], [4.0, 2.0, 2.0]);
        let mut moves = plan(&from, &to, |i, j| (x[i] - y[j]).powi(2));
        moves.sort_by(|a, b| x[a.from].total_cmp(&x[b.from]).then(y[a.to].total_cmp(&y[b.to])));
        let expected = [(1, 0, 2.0), (3, 0, 2.0), (2, 2, 2.0), (2, 1, 1.0), (0, 1, 1.0)];
        assert_eq!(moves.len(), expected.len());
        for (found, (from, to, mass)) in moves.iter().zip(expected) {
            assert_eq!((found.from, found.to), (from, to));
            assert!((found.mass - mass / 8.0).abs() < 1e-12);
        }
    }

    #[test]
    fn equal_masses_are_assigned_as_the_best_permutation_is() {
        let points = |seed: u64| -> Vec<(f64, f64)> {
            let at = |k: u64| ((k * 7_919 + seed * 104_729) % 1_009) as f64 / 1_009.0;
            (0..6).map(|k| (at(2 * k + 1), at(2 * k + 2))).collect()
        };
        for seed in 1..20 {
            let (a, b) = (points(seed), points(seed + 50));
            let cost = |i: usize, j: usize| (a[i].0 - b[j].0).powi(2) + (a[i].1 - b[j].1).powi(2);
            let moves = plan(&[1.0; 6], &[1.0; 6], cost);
            let ours: f64 = moves.iter().map(|m| 6.0 * m.mass * cost(m.from, m.to)).sum();
            let mut best = f64::INFINITY;
            permutations(&mut [0, 1, 2, 3, 4, 5], 0, &mut |order: &[usize; 6]| {
                best = best.min((0..6).map(|i| cost(i, order[i])).sum());
            });
            assert!((ours - best).abs() < 1e-9, "{seed}: {ours} {best}");
        }
    }

    fn permutations(order: &mut [usize; 6], at: usize, visit: &mut impl FnMut(&[usize; 6])) {
        if at == order.len() {
            return visit(order);
        }
        for k in at..order.len() {
            order.swap(at, k);
            permutations(order, at + 1, visit);
            order.swap(at, k);
        }
    }
}
