# Edge and peak force there against voltage, layers, gap and stiffness (figures 7, 9, 11, 13).
set datafile separator ','
set terminal pngcairo size 900,1100 font 'sans,11'
set output 'results/wu2022/trends.png'
set multiplot layout 4,2
set grid lc '#dddddd'
set key bottom right
folder = 'results/wu2022/'
set offsets graph 0.02, graph 0.02, graph 0.1, graph 0.1
set xlabel 'phi_{pp} (7)'
set ylabel 'omega_p'
plot folder.'fig7-edge.csv' using 2:3 skip 1 with lines lc '#888888' title 'where the free motion touches', \
     folder.'fig7.csv' using 3:5 skip 1 with points pt 7 ps 0.6 lc '#1f77b4' title 'edge'
set ylabel 'peak force'
plot folder.'fig7.csv' using 3:6 skip 1 with linespoints pt 7 ps 0.6 lc '#d62728' notitle
set xlabel 'layers n (9)'
set ylabel 'omega_p'
plot folder.'fig9.csv' using 4:5 skip 1 with linespoints pt 7 ps 0.6 lc '#1f77b4' notitle
set ylabel 'peak force'
plot folder.'fig9.csv' using 4:6 skip 1 with linespoints pt 7 ps 0.6 lc '#d62728' notitle
set xlabel 'g (11)'
set xtics 0.05
set ylabel 'omega_p'
plot folder.'fig11.csv' using 1:5 skip 1 with linespoints pt 7 ps 0.6 lc '#1f77b4' notitle
set ylabel 'peak force'
plot folder.'fig11.csv' using 1:6 skip 1 with linespoints pt 7 ps 0.6 lc '#d62728' notitle
set logscale x
set xtics auto
set format x '10^{%L}'
set xlabel 'k (13)'
set ylabel 'omega_p'
plot [][1:3] folder.'fig13.csv' using 2:5 skip 1 with linespoints pt 7 ps 0.6 lc '#1f77b4' notitle
set ylabel 'peak force'
plot folder.'fig13.csv' using 2:6 skip 1 with linespoints pt 7 ps 0.6 lc '#d62728' notitle
unset multiplot
