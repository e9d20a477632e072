//! What a sweep and a measurement cost a bead, on tight trefoils from n = 480 to 30,000.
//!
//! `cargo bench` gives the throughput in beads: 50 Melem/s are 20 ns a bead and sweep.

use std::f64::consts::TAU;
use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use sono::{Curve, Outcome, Settings, Tightener, measure, refine};

/// Sweeps in one sample: what comes every thousandth sweep comes in every sample.
const SWEEPS: u64 = 1000;

fn loose_trefoil() -> Curve {
    let vertex = |i: usize| {
        let t = TAU * i as f64 / 120.;
        let r = 2. + 0.8 * (3. * t).cos();
        DVec3::new(r * (2. * t).cos(), r * (2. * t).sin(), 0.8 * (3. * t).sin())
    };
    Curve::new(vec![(0..120).map(vertex).collect()]).expect("a trefoil is a curve")
}

fn finish(mut tightener: Tightener) -> Curve {
    while tightener.step() == Outcome::Running {}
    tightener.best().clone()
}

/// A trefoil tightened at n = 480.
fn tight_trefoil() -> Curve {
    let settings = Settings { anneal_sweeps: 50_000, settle_sweeps: 200, ..Default::default() };
    let mut curve =
        finish(Tightener::collapse(&loose_trefoil(), 1000, settings).expect("embedded"));
    curve = finish(Tightener::anneal(&curve, 120, settings).expect("fine enough"));
    for n in [120, 240, 480] {
        curve = finish(Tightener::settle(&curve, n, settings).expect("fine enough"));
    }
    curve
}

fn benchmarks(criterion: &mut Criterion) {
    let tight = tight_trefoil();
    let mut group = criterion.benchmark_group("trefoil");
    group
        .sample_size(10)
        .measurement_time(std::time::Duration::from_secs(2))
        .warm_up_time(std::time::Duration::from_secs(1));
    for n in [480, 1920, 7680, 30_000] {
        let curve = refine(&tight, n, 0.25);
        let settings = Settings { settle_sweeps: 10_000_000, ..Default::default() };
        let mut settling = Tightener::settle(&curve, n, settings).expect("fine enough");
        for _ in 0..SWEEPS {
            settling.step();
        }
        group.throughput(Throughput::Elements(SWEEPS * n as u64));
        group.bench_function(BenchmarkId::new("sweep", n), |bencher| {
            bencher.iter(|| {
                for _ in 0..SWEEPS {
                    settling.step();
                }
            });
        });
        group.throughput(Throughput::Elements(n as u64));
        group.bench_function(BenchmarkId::new("measure", n), |bencher| {
            bencher.iter(|| measure(black_box(&curve)));
        });
    }
    group.finish();
}

criterion_group!(benches, benchmarks);
criterion_main!(benches);
