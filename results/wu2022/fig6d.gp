# A disturbance: three drive cycles without voltage from cycle 20.
set datafile separator ','
set terminal pngcairo size 900,520 font 'sans,11'
set output 'results/wu2022/fig6d.png'
set multiplot layout 2,1
set xrange [10:60]
set grid lc '#dddddd'
set xlabel 'drive cycle'
set ylabel 'x'
set yrange [0.2:0.6]
stop(x) = 0.5
set title 'omega = 2.2, two motions coexist: it falls'
plot 'results/wu2022/fig6d-fall.csv' using 1:2 skip 1 with lines lc '#1f77b4' notitle, stop(x) lc 'black' dt 2 title 'stop'
set title 'omega = 1.92, one motion: it recovers'
plot 'results/wu2022/fig6d-recovery.csv' using 1:2 skip 1 with lines lc '#1f77b4' notitle, stop(x) lc 'black' dt 2 title 'stop'
unset multiplot
